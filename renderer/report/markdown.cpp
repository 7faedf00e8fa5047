#include "renderer/report/markdown.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/number_text.h"
#include "renderer/report/across_table.h"
#include "renderer/report/check_text.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::Check, report::CheckOutcome, report::Report, report::Result;

namespace {

/// As text within a table: labels and reasons may contain anything.
std::string cell(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '\n' || c == '\r') {
            safe += ' ';
        } else if (std::string_view("\\`*_{}[]<>|#!~&@").find(c) != std::string_view::npos) {
            safe += fmt::format("&#{};", static_cast<int>(c));
        } else {
            safe += c;
        }
    }
    return safe;
}

std::string at_text(const report::Point& point) {
    return point.empty() ? "" : " at " + describe_point(point);
}

std::string verdict_line(const Report& report) {
    const std::string word = report.status == report::Status::done ? word_of(report.verdict) : word_of(report.status);
    std::string line = fmt::format("### Sheer: {}", word);
    if (!report.title().empty()) line += ": " + cell(report.title());
    line += "\n\n";
    if (report.error) return line + cell(report.error->title + ": " + report.error->detail) + "\n";
    if (!report.verdict_reason.empty()) line += cell(report.verdict_reason) + ".\n";
    if (report.against) line += cell(report.against->text) + ".\n";
    return line;
}

/// What would decide an undecided check.
std::string advice(const Check& check, const Report& report) {
    if (check.came_out() != CheckOutcome::undecided) return check.reason;
    if (check.metric.starts_with("against.")) return check.reason + "; a larger timing.rounds would decide it";
    const double max_seconds = report.spec.value(nlohmann::json::json_pointer("/timing/max_seconds"), 60.0);
    return fmt::format("{}; more time would decide it: timing.max_seconds over {}", check.reason,
                       number_text(max_seconds));
}

std::string limits(const Check& check) {
    std::string text = check_limits(check);
    return text.empty() ? "" : text.substr(1);
}

std::string check_rows(const Report& report) {
    if (report.checks.empty()) return "There are no checks.\n";
    std::vector<Check> checks = report.checks;
    const auto rank = [](const Check& check) {
        return check.came_out() == CheckOutcome::failed ? 0 : check.came_out() == CheckOutcome::undecided ? 1 : 2;
    };
    std::ranges::stable_sort(checks, {}, rank);
    std::string text = "| outcome | check | value | wanted | |\n|---|---|---|---|---|\n";
    for (const Check& check : checks)
        text += fmt::format("| {} | {} | {} | {} | {} |\n", word_of(check.came_out()),
                            cell(check.metric + " of " + check.method + at_text(check.at)), cell(check_value(check)),
                            limits(check), cell(advice(check, report)));
    return text;
}

std::string picture_text(const Result& result, const MarkdownLinks& links) {
    const auto found = result.images.find("color");
    if (!links.pictures || found == result.images.end()) return "";
    return fmt::format("<a href=\"{0}{1}\"><img src=\"{0}{1}\" width=\"96\" alt=\"\"></a> ", links.picture_prefix,
                       found->second.url);
}

std::string value_of(const Result& result, const std::string& name) {
    const auto value = find_quantity(name)->value(result);
    return value ? number_text(*value) : "-";
}

std::string speed_text(const Result& result) {
    if (!result.speedup) return "-";
    const std::string text = number_text(result.speedup->value) + "×";
    if (!result.speedup->ci95) return text;
    return fmt::format("{} [{}, {}]", text, number_text((*result.speedup->ci95)[0]),
                       number_text((*result.speedup->ci95)[1]));
}

std::string method_rows(const report::Run& run, const MarkdownLinks& links) {
    std::string text = "| method | median ms | speed-up | FLIP | |\n|---|---|---|---|---|\n";
    for (const Result& result : run.results) {
        const bool is_ok = result.status == report::ResultStatus::ok;
        text += fmt::format("| {}{} | {} | {} | {} | {} |\n", picture_text(result, links), cell(result.label),
                            value_of(result, "timing.median"), speed_text(result), value_of(result, "flip.mean"),
                            is_ok ? (result.speedup ? word_of(result.speedup->verdict) : "")
                                  : cell(word_of(result.status) + ": " + result.reason));
    }
    return text;
}

/// A table row for each method and point, with columns for each device.
std::string device_rows(const Report& report) {
    std::string text, heading_end;
    for (const TableRow& row : across_rows(report)) {
        for (const std::string& column : row) text += "| " + cell(column) + " ";
        text += "|\n";
        if (!heading_end.empty()) continue;
        for (std::size_t i = 0; i < row.size(); ++i) heading_end += i == 0 ? "|---" : "|--:";
        text += heading_end + "|\n";
    }
    return text + "\n" + cell(across_caption(report)) + "\n";
}

/// A message of a workflow command.
std::string escaped_message(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '%' || c == '\r' || c == '\n') {
            safe += fmt::format("%{:02X}", static_cast<int>(c));
        } else {
            safe += c;
        }
    }
    return safe;
}

/// A property of one.
std::string escaped_property(const std::string& text) {
    std::string safe;
    for (const char c : escaped_message(text)) {
        if (c == ':' || c == ',') {
            safe += fmt::format("%{:02X}", static_cast<int>(c));
        } else {
            safe += c;
        }
    }
    return safe;
}

}  // namespace

std::string report_markdown(const Report& report, const MarkdownLinks& links) {
    std::string text = verdict_line(report);
    if (!links.report.empty()) text += fmt::format("\n[The report]({})\n", links.report);
    if (report.status == report::Status::done) text += "\n" + check_rows(report);
    // A sweep has its figures in the report; here a table for each point would bury the verdict.
    if (report.runs.size() == 1) text += "\n" + method_rows(report.runs.front(), links);
    if (!report.across_devices.empty()) return text + "\n" + device_rows(report);
    if (report.runs.size() > 1) text += fmt::format("\n{} points of a sweep.\n", report.runs.size());
    return text;
}

std::string report_annotations(const Report& report, const std::string& file) {
    const std::string where = file.empty() ? "" : "file=" + escaped_property(file) + ",";
    std::string text;
    const auto add = [&](const char* level, const std::string& message) {
        text += fmt::format("::{} {}title=Sheer::{}\n", level, where, escaped_message(message));
    };
    if (report.error) add("error", report.error->title + ": " + report.error->detail);
    for (const Check& check : report.checks) {
        if (check.came_out() == CheckOutcome::passed) continue;
        const std::string reason = check.reason.empty() ? "" : ": " + check.reason;
        const bool is_failed = check.came_out() == CheckOutcome::failed;
        add(is_failed ? "error" : "warning",
            fmt::format("{} of {}{} is {}, wanted{}{}", check.metric, check.method, at_text(check.at),
                        is_failed ? check_value(check) : "undecided", check_limits(check), reason));
    }
    for (const report::Run& run : report.runs)
        for (const Result& result : run.results)
            if (result.status == report::ResultStatus::failed)
                add("error", fmt::format("{} failed to render{}: {}", result.label, at_text(run.point), result.reason));
    return text;
}

}  // namespace sheer
