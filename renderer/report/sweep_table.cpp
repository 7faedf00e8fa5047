#include "renderer/report/sweep_table.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "renderer/report/text_table.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::Report, report::Result, report::SpeedVerdict;

namespace {

std::vector<std::string> contenders(const Report& report) {
    std::vector<std::string> labels;
    for (const auto& method : report.spec.at("methods"))
        if (method.at("label") != report.baseline()) labels.push_back(method["label"]);
    return labels;
}

bool is_resolved(const report::Speedup& speedup) {
    return speedup.verdict != SpeedVerdict::not_resolved;
}

std::string speedup_cell(const Result* result) {
    if (!result) return "-";
    if (result->status != report::ResultStatus::ok) return word_of(result->status);
    if (!result->speedup) return "-";
    const report::Speedup& speedup = *result->speedup;
    const std::string ratio = fmt::format("{:.2f}x", speedup.value);
    return is_resolved(speedup) ? ratio + " " + word_of(speedup.verdict) : ratio;
}

/// "faster at count 64; count 256" or "".
std::string places(const Report& report, const std::string& label, SpeedVerdict verdict) {
    std::string text;
    for (const report::Run& run : report.runs) {
        const Result* result = run.find(label);
        if (result && result->speedup && result->speedup->verdict == verdict)
            text += (text.empty() ? "" : "; ") + describe_point(run.point);
    }
    return text.empty() ? "" : fmt::format("{} at {}", word_of(verdict), text);
}

std::string sentence(const Report& report, const std::string& label) {
    const std::string faster = places(report, label, SpeedVerdict::faster),
                      slower = places(report, label, SpeedVerdict::slower);
    const std::string both = faster.empty() || slower.empty() ? faster + slower : faster + ". It is " + slower;
    return fmt::format("{} is {}.\n", label, both.empty() ? "not resolved to be faster or slower at any point" : both);
}

/// Memory that does not grow is not worth a word.
bool is_told(const report::Growth& growth) {
    return growth.metric == "timing.median" || std::abs(growth.exponent) >= 0.005;
}

/// "At size 64, time grows as count^p, p = 0.98 [0.91, 1.05] for b2f, ..." for each metric, field and rest of the
/// point.
std::string growth_text(const Report& report) {
    std::string text;
    const report::Growth* before = nullptr;
    for (const report::Growth& growth : report.growth) {
        if (!is_told(growth)) continue;
        const bool continues =
            before && before->metric == growth.metric && before->pointer == growth.pointer && before->at == growth.at;
        const std::string field = describe_point({{growth.pointer, 0}});
        const std::string at = describe_point(growth.at);
        const bool time = growth.metric == "timing.median";
        if (!continues)
            text += fmt::format(
                "{}{} grows as {}^p, p = ", before ? ".\n" : "",
                at.empty() ? (time ? "Time" : "Memory") : fmt::format("At {}, {}", at, time ? "time" : "memory"),
                field.substr(0, field.rfind(' ')));
        text += fmt::format("{}{:.2f} [{:.2f}, {:.2f}] for {}", continues ? ", " : "", growth.exponent, growth.ci95[0],
                            growth.ci95[1], growth.method);
        before = &growth;
    }
    return text.empty() ? "" : text + ".\n";
}

}  // namespace

std::string sweep_table(const Report& report) {
    const std::vector<std::string> labels = contenders(report);
    if (report.runs.size() < 2 || labels.empty()) return growth_text(report);
    std::vector<TableRow> rows = {{"speedup at"}};
    rows[0].insert(rows[0].end(), labels.begin(), labels.end());
    for (const report::Run& run : report.runs) {
        rows.push_back({describe_point(run.point)});
        for (const std::string& label : labels) rows.back().push_back(speedup_cell(run.find(label)));
    }
    std::string text = fmt::format("\n{}\nBeside {}:\n", aligned(rows), report.baseline());
    for (const std::string& label : labels) text += sentence(report, label);
    return text + growth_text(report);
}

}  // namespace sheer
