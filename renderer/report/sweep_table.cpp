#include "renderer/report/sweep_table.h"

#include <fmt/format.h>

#include <vector>

#include "renderer/report/measured.h"
#include "renderer/report/text_table.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

std::vector<std::string> contenders(const json& report) {
    std::vector<std::string> labels;
    for (const json& method : report["spec"]["methods"])
        if (method["label"] != report["spec"]["baseline"]) labels.push_back(method["label"]);
    return labels;
}

std::string verdict_of_speedup(const json* result) {
    return result && (*result)["speedup"].is_object() ? (*result)["speedup"]["verdict"].get<std::string>() : "";
}

std::string speedup_cell(const json* result) {
    if (!result) return "-";
    if ((*result)["status"] != "ok") return (*result)["status"];
    if (!(*result)["speedup"].is_object()) return "-";
    const std::string verdict = verdict_of_speedup(result);
    const std::string ratio = fmt::format("{:.2f}x", (*result)["speedup"]["value"].get<double>());
    return verdict == "faster" || verdict == "slower" ? ratio + " " + verdict : ratio;
}

/// "faster at count 64; count 256" or "".
std::string places(const json& report, const std::string& label, const std::string& verdict) {
    std::string text;
    for (const json& run : report["runs"])
        if (verdict_of_speedup(find_result(run, label)) == verdict)
            text += (text.empty() ? "" : "; ") + describe_point(run["point"]);
    return text.empty() ? "" : fmt::format("{} at {}", verdict, text);
}

std::string sentence(const json& report, const std::string& label) {
    const std::string faster = places(report, label, "faster"), slower = places(report, label, "slower");
    const std::string both = faster.empty() || slower.empty() ? faster + slower : faster + ". It is " + slower;
    return fmt::format("{} is {}.\n", label, both.empty() ? "nowhere resolved to be faster or slower" : both);
}

}  // namespace

std::string sweep_table(const json& report) {
    const std::vector<std::string> labels = contenders(report);
    if (report["runs"].size() < 2 || labels.empty()) return "";
    std::vector<TableRow> rows = {{"speedup at"}};
    rows[0].insert(rows[0].end(), labels.begin(), labels.end());
    for (const json& run : report["runs"]) {
        rows.push_back({describe_point(run["point"])});
        for (const std::string& label : labels) rows.back().push_back(speedup_cell(find_result(run, label)));
    }
    std::string text = fmt::format("\n{}\nBeside {}:\n", aligned(rows), report["spec"]["baseline"].get<std::string>());
    for (const std::string& label : labels) text += sentence(report, label);
    return text;
}

}  // namespace sheer
