#include "renderer/report/provenance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <set>
#include <system_error>

namespace sheer {

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

std::string driver_of(const std::string& gl_version) {
    std::size_t begin = gl_version.find(' ');
    if (begin == std::string::npos) return "";
    if (gl_version.compare(begin, 2, " (") == 0) {
        begin = gl_version.find(") ", begin);
        if (begin == std::string::npos) return "";
        ++begin;
    }
    return gl_version.substr(begin + 1);
}

OrReason<std::string> governor(const std::filesystem::path& cpus) {
    std::set<std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(cpus, error), end; !error && entry != end; entry.increment(error)) {
        std::ifstream file(entry->path() / "cpufreq" / "scaling_governor");
        std::string name;
        if (file >> name) found.insert(name);
    }
    if (found.empty())
        return {{}, fmt::format("{} names no governor, as in most virtual machines", (cpus / "cpu*/cpufreq").string())};
    return {fmt::format("{}", fmt::join(found, ", ")), ""};
}

std::optional<report::LoadAverage> load_average(const std::filesystem::path& file) {
    std::ifstream stream(file);
    report::LoadAverage load;
    if (!(stream >> load[0] >> load[1] >> load[2])) return std::nullopt;
    return load;
}

report::ColorSpace color_space() {
    return {
        .values = "display-referred, encoded as sRGB",
        .blending = "in these values as they are, without conversion to linear light, as in the SCCG 2010 paper",
        .quantised_metrics = "on the values clamped to 0..1 and rounded to 1/255; FLIP decodes them as sRGB",
        .float_metrics = "linear and over_backgrounds: on the blended values, neither clamped nor rounded nor decoded"};
}

}  // namespace sheer
