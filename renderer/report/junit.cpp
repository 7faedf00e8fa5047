#include <fmt/format.h>

#include "renderer/report/report.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return result;
}

/// `problem` is an element inside the case, or "".
std::string test_case(const std::string& name, const std::string& problem) {
    return fmt::format("  <testcase classname=\"sheer\" name=\"{}\">{}</testcase>\n", escaped(name), problem);
}

std::string limits(const json& check) {
    std::string text;
    if (!check["min"].is_null()) text += " at least " + check["min"].dump();
    if (!check["max"].is_null()) text += " at most " + check["max"].dump();
    return text;
}

std::string note_properties(const json& notes) {
    if (notes.empty()) return "";
    std::string properties;
    for (const json& note : notes) {
        const std::string where = note["where"].is_null() ? "" : note["where"].get<std::string>() + ": ";
        properties += fmt::format("    <property name=\"note.{}\" value=\"{}\"/>\n", escaped(note["code"]),
                                  escaped(where + note["text"].get<std::string>()));
    }
    return "  <properties>\n" + properties + "  </properties>\n";
}

}  // namespace

std::string report_junit(const json& report) {
    std::string cases;
    int count = 0, failures = 0, skipped = 0;
    for (const json& check : report["checks"]) {
        ++count;
        std::string problem;
        if (!check["passed"].get<bool>()) {
            ++failures;
            problem = fmt::format("<failure message=\"{}\"/>",
                                  escaped("is " + check["value"].dump() + ", wanted" + limits(check)));
        }
        std::string name = fmt::format("{} of {}{}", check["metric"].get<std::string>(),
                                       check["method"].get<std::string>(), limits(check));
        if (!check["at"].empty()) name += " at " + check["at"].dump();
        cases += test_case(name, problem);
    }
    for (const json& run : report["runs"]) {
        for (const json& result : run["results"]) {
            ++count;
            std::string problem;
            if (result["status"] == "unsupported") {
                ++skipped;
                problem = fmt::format("<skipped message=\"{}\"/>", escaped(result["reason"]));
            } else if (result["status"] != "ok") {
                ++failures;
                problem = fmt::format("<failure message=\"{}\"/>", escaped(result["reason"]));
            }
            cases += test_case("renders " + result["label"].get<std::string>(), problem);
        }
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
        "errors=\"0\" skipped=\"{}\" timestamp=\"{}\">\n{}{}</testsuite>\n",
        escaped(report["spec"]["title"]), count, failures, skipped, escaped(report["created_at"]),
        note_properties(report.value("notes", json::array())), cases);
}

}  // namespace sheer
