#include <fmt/format.h>

#include "renderer/number_text.h"
#include "renderer/report/check_text.h"
#include "renderer/report/report.h"
#include "renderer/report/xml_text.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

/// The test cases of a suite, and how many came out how.
class Cases {
  public:
    void pass(const std::string& name) { add(name, ""); }
    void skip(const std::string& name, const std::string& why) {
        ++m_skipped;
        add(name, fmt::format("<skipped message=\"{}\"/>", xml_text(why)));
    }
    void fail(const std::string& name, const std::string& why) {
        ++m_failures;
        add(name, fmt::format("<failure message=\"{}\"/>", xml_text(why)));
    }
    void err(const std::string& name, const std::string& title, const std::string& detail) {
        ++m_errors;
        add(name, fmt::format("<error message=\"{}\">{}</error>", xml_text(title), xml_text(detail)));
    }

    std::string suite(const std::string& name, const std::string& timestamp, const std::string& properties) const {
        return fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
            "errors=\"{}\" skipped=\"{}\" timestamp=\"{}\">\n{}{}</testsuite>\n",
            xml_text(name), m_count, m_failures, m_errors, m_skipped, xml_text(timestamp), properties, m_text);
    }

  private:
    /// `outcome` is an element inside the case, or "".
    void add(const std::string& name, const std::string& outcome) {
        ++m_count;
        m_text += fmt::format("  <testcase classname=\"sheer\" name=\"{}\">{}</testcase>\n", xml_text(name), outcome);
    }

    std::string m_text;
    int m_count = 0, m_failures = 0, m_errors = 0, m_skipped = 0;
};

std::string note_properties(const json& notes) {
    if (notes.empty()) return "";
    std::string properties;
    for (const json& note : notes) {
        const std::string where = note["where"].is_null() ? "" : note["where"].get<std::string>() + ": ";
        properties +=
            fmt::format("    <property name=\"note.{}\" value=\"{}\"/>\n", xml_text(note["code"].get<std::string>()),
                        xml_text(where + note["text"].get<std::string>()));
    }
    return "  <properties>\n" + properties + "  </properties>\n";
}

void add_checks(const json& checks, Cases& cases) {
    for (const json& check : checks) {
        const std::string name = check_name(check);
        const std::string outcome = check_outcome(check);
        const json reason = check.value("reason", json());
        const std::string text = fmt::format("is {}, wanted{}{}", check_value(check), check_limits(check),
                                             reason.is_string() ? ": " + reason.get<std::string>() : "");
        if (outcome == "passed") {
            cases.pass(name);
        } else if (outcome == "undecided") {
            cases.skip(name, "undecided: " + text);
        } else {
            cases.fail(name, text);
        }
    }
}

void add_results(const json& runs, Cases& cases) {
    for (const json& run : runs) {
        const std::string point = describe_point(run["point"]), place = point.empty() ? "" : " at " + point;
        for (const json& result : run["results"]) {
            const std::string name = "renders " + result["label"].get<std::string>() + place;
            const json nothing_drawn = run.value("nothing_drawn", json());
            if (result["status"] == "ok" && nothing_drawn.is_string()) {
                cases.skip(name, nothing_drawn);
            } else if (result["status"] == "ok") {
                cases.pass(name);
            } else if (result["status"] == "unsupported") {
                cases.skip(name, result["reason"]);
            } else {
                cases.fail(name, result["reason"]);
            }
        }
    }
}

}  // namespace

std::string report_junit(const json& report) {
    Cases cases;
    add_checks(report.value("checks", json::array()), cases);
    add_results(report.value("runs", json::array()), cases);
    if (const json status = report.value("status", json("done")); status != "done") {
        const json error = report.value("error", json());
        const std::string title =
            error.is_object() ? error.value("title", "") : "The comparison is " + status.get<std::string>();
        cases.err("the comparison ends", title, error.is_object() ? error.value("detail", "") : "");
    }
    const json spec = report.value("spec", json::object());
    return cases.suite(spec.value("title", ""), report.value("created_at", ""),
                       note_properties(report.value("notes", json::array())));
}

}  // namespace sheer
