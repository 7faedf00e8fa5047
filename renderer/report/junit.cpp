#include <fmt/format.h>

#include <map>
#include <optional>
#include <pugixml.hpp>
#include <sstream>

#include "renderer/core/number_text.h"
#include "renderer/report/check_text.h"
#include "renderer/report/report.h"
#include "renderer/report/xml_text.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::Report;

namespace {

void set_attribute(pugi::xml_node node, const char* attribute, const std::string& text) {
    node.append_attribute(attribute) = xml_text(text).c_str();
}

/// A document with one <testsuite>, whose attributes count the outcomes of its cases.
class JunitSuite {
  public:
    JunitSuite(const std::string& name, const std::string& timestamp,
               const std::vector<std::pair<std::string, std::string>>& properties) {
        pugi::xml_node declaration = m_document.append_child(pugi::node_declaration);
        declaration.append_attribute("version") = "1.0";
        declaration.append_attribute("encoding") = "UTF-8";
        m_suite = m_document.append_child("testsuite");
        set_attribute(m_suite, "name", name);
        for (const char* count : {"tests", "failures", "errors", "skipped"}) m_suite.append_attribute(count) = 0;
        set_attribute(m_suite, "timestamp", timestamp);
        if (!properties.empty()) add_properties(properties);
    }

    /// `time_s` is how long it took, if that is known.
    void pass(const std::string& name, std::optional<double> time_s = {}) {
        pugi::xml_node test_case = add(name);
        if (time_s) set_attribute(test_case, "time", fmt::format("{:.3f}", *time_s));
    }
    void skip(const std::string& name, const std::string& why) { add_outcome(name, "skipped", "skipped", why); }
    void fail(const std::string& name, const std::string& why) { add_outcome(name, "failures", "failure", why); }
    void err(const std::string& name, const std::string& title, const std::string& detail) {
        pugi::xml_node element = add_outcome(name, "errors", "error", title);
        if (!detail.empty()) element.text() = xml_text(detail).c_str();
    }

    std::string text() const {
        std::ostringstream text;
        m_document.save(text, "  ");
        return text.str();
    }

  private:
    void add_properties(const std::vector<std::pair<std::string, std::string>>& properties) {
        pugi::xml_node all = m_suite.append_child("properties");
        for (const auto& [name, value] : properties) {
            pugi::xml_node property = all.append_child("property");
            set_attribute(property, "name", name);
            set_attribute(property, "value", value);
        }
    }

    pugi::xml_node add(const std::string& name) {
        count("tests");
        pugi::xml_node test_case = m_suite.append_child("testcase");
        test_case.append_attribute("classname") = "sheer";
        set_attribute(test_case, "name", name);
        return test_case;
    }

    /// Returns the element with the case's outcome.
    pugi::xml_node add_outcome(const std::string& name, const char* counted_as, const char* outcome,
                               const std::string& message) {
        pugi::xml_node element = add(name).append_child(outcome);
        count(counted_as);
        set_attribute(element, "message", message);
        return element;
    }

    void count(const char* attribute) {
        pugi::xml_attribute number = m_suite.attribute(attribute);
        number = number.as_int() + 1;
    }

    pugi::xml_document m_document;
    pugi::xml_node m_suite;
};

/// A name must not change with the limits, or a history of the case would end; so cases that differ only in those are
/// numbered.
class StableNames {
  public:
    std::string unique(const std::string& name) {
        const int number = ++m_count[name];
        return number == 1 ? name : fmt::format("{} ({})", name, number);
    }

  private:
    std::map<std::string, int> m_count;
};

void add_checks(const Report& report, JunitSuite& suite) {
    const std::string on_undecided = report.spec.value("on_undecided", "neutral");
    StableNames names;
    for (const report::Check& check : report.checks) {
        const std::string name = names.unique(check_name(check));
        const std::string text = fmt::format("is {}, wanted{}{}", check_value(check), check_limits(check),
                                             check.reason.empty() ? "" : ": " + check.reason);
        switch (check.came_out()) {
            case report::CheckOutcome::passed:
                suite.pass(name);
                break;
            case report::CheckOutcome::undecided:
                if (on_undecided == "pass") {
                    suite.pass(name);
                } else if (on_undecided == "fail") {
                    suite.fail(name, "undecided: " + text);
                } else {
                    suite.skip(name, "undecided: " + text);
                }
                break;
            case report::CheckOutcome::failed:
                suite.fail(name, text);
        }
    }
}

/// The timed frames of a method together.
std::optional<double> timed_seconds(const report::Result& result) {
    if (!result.timing) return std::nullopt;
    double sum_ms = 0;
    for (const double sample_ms : result.timing->wall_samples) sum_ms += sample_ms;
    return sum_ms / 1000;
}

void add_result(const report::Result& result, const std::string& name, const std::string& nothing_drawn,
                JunitSuite& suite) {
    switch (result.status) {
        case report::ResultStatus::ok:
            if (nothing_drawn.empty()) {
                suite.pass(name, timed_seconds(result));
            } else {
                suite.skip(name, nothing_drawn);
            }
            break;
        case report::ResultStatus::unsupported:
            suite.skip(name, result.reason);
            break;
        case report::ResultStatus::failed:
            suite.fail(name, result.reason);
    }
}

void add_results(const std::vector<report::Run>& runs, JunitSuite& suite) {
    for (const report::Run& run : runs) {
        const std::string point = describe_point(run.point), place = point.empty() ? "" : " at " + point;
        for (const report::Result& result : run.results)
            add_result(result, "renders " + result.label + place, run.nothing_drawn, suite);
    }
}

/// Which report it is, where it was made, what it was compared with, and its notes.
std::vector<std::pair<std::string, std::string>> properties_of(const Report& report) {
    std::vector<std::pair<std::string, std::string>> all;
    const auto add = [&](const std::string& name, const std::string& value) {
        if (!value.empty()) all.emplace_back(name, value);
    };
    add("report", report.id);
    add("spec_sha256", report.spec_sha256);
    if (report.status == report::Status::done) add("verdict", word_of(report.verdict));
    add("verdict_reason", report.verdict_reason);
    if (report.device && report.devices.empty()) add("device", report.device->renderer);
    for (const report::DevicePart& part : report.devices)
        add("device." + part.label, part.device ? part.device->renderer : "failed: " + part.reason);
    add("version", report.provenance.version);
    if (report.against) add("against", report.against->text);
    for (const Note& note : report.notes)
        add("note." + note.code, (note.where.empty() ? "" : note.where + ": ") + note.text);
    return all;
}

}  // namespace

std::string report_junit(const Report& report) {
    JunitSuite suite(report.title(), report.created_at, properties_of(report));
    add_checks(report, suite);
    add_results(report.runs, suite);
    if (report.status != report::Status::done)
        suite.err("the comparison ends",
                  report.error ? report.error->title : "The comparison is " + word_of(report.status),
                  report.error ? report.error->detail : "");
    return suite.text();
}

}  // namespace sheer
