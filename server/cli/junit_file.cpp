#include "server/cli/junit_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <string_view>

#include "renderer/core/clock.h"
#include "renderer/core/files.h"
#include "renderer/report/report.h"
#include "server/cli/commands.h"
#include "server/cli/manifest.h"

namespace sheer::cli {

namespace fs = std::filesystem;

namespace {

bool lies_in(const fs::path& file, const fs::path& folder) {
    const fs::path below = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
    return !below.empty() && *below.begin() != "..";
}

/// Names in the report's folder that are reserved for the report.
bool is_reports_own(const fs::path& file, const fs::path& out) {
    if (out.empty() || !lies_in(file, out)) return false;
    const fs::path first = *fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(out)).begin();
    return first == "report.json" || first == "report.html" || first == "images" || first == "incomplete" ||
           first == Manifest::file_name || first == ".sheer-partial";
}

/// The word after --junit of a command line that cannot be read as a whole; "" if there is none.
std::string junit_argument(int argc, const char* const* argv) {
    constexpr std::string_view option = "--junit";
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == option && i + 1 < argc) return argv[i + 1];
        if (word.starts_with(option) && word.substr(option.size()).starts_with('='))
            return std::string(word.substr(option.size() + 1));
    }
    return "";
}

}  // namespace

JunitFile::JunitFile(const std::string& file, const fs::path& spec, const fs::path& out) : m_file(file) {
    if (m_file.empty()) return;
    std::error_code error;
    if (fs::equivalent(m_file, spec, error)) throw UsageError("--junit names the spec itself, " + file);
    if (is_reports_own(m_file, out)) throw UsageError("--junit names a file of the report, " + file);
    const fs::path folder = m_file.parent_path();
    if (!out.empty() && !folder.empty() && lies_in(folder, out)) fs::create_directories(folder, error);
    const bool is_plain = !fs::exists(m_file, error) || fs::is_regular_file(m_file, error);
    // Data written to a pipe cannot be taken back, and opening one may wait for its reader.
    const bool is_writable = is_plain ? bool(std::ofstream(m_file, std::ios::binary | std::ios::app))
                                      : !fs::is_directory(m_file, error) && access(m_file.c_str(), W_OK) == 0;
    if (!is_writable) throw UsageError("cannot write " + file);
    if (is_plain) write_error("The comparison did not end", "Nothing was written after it started.");
}

void JunitFile::write(const report::Report& report) const {
    if (!m_file.empty()) write_file(m_file, report_junit(report));
}

void JunitFile::write_error(const std::string& title, const std::string& detail) const {
    report::Report report;
    report.status = report::Status::failed;
    report.error = report::Error{title, detail};
    report.spec = {{"title", "sheer compare"}};
    report.created_at = utc_now();
    write(report);
}

void note_wrong_command_line(int argc, const char* const* argv, const std::string& message) {
    const std::string_view command = argc > 1 ? argv[1] : "";
    if (command != "compare" && command != "submit") return;
    try {
        JunitFile(junit_argument(argc, argv), "", "").write_error("The command line is wrong", message);
    } catch (const std::exception& error) {
        fmt::print(stderr, "sheer: {}\n", error.what());
    }
}

}  // namespace sheer::cli
