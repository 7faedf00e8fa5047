#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "renderer/core/number_text.h"
#include "renderer/report/across_table.h"
#include "renderer/report/check_text.h"
#include "renderer/report/report.h"
#include "renderer/report/sweep_table.h"
#include "renderer/report/text_table.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::Report, report::Result, report::ResultStatus;

namespace {

using Row = TableRow;

/// The metrics that have a column.
std::vector<const Quantity*> metric_columns() {
    std::vector<const Quantity*> columns;
    for (const Quantity& quantity : all_quantities())
        if (!quantity.terminal.head.empty()) columns.push_back(&quantity);
    return columns;
}

std::string number(const std::optional<double>& value, int decimals) {
    return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

/// The quantity of this name in a result, or a dash if it has none.
std::string number(const Result& result, const std::string& name, int decimals) {
    return number(find_quantity(name)->value(result), decimals);
}

/// A ratio of times with its interval.
std::string ratio_text(double value, const std::optional<report::Interval>& ci95) {
    const std::string text = fmt::format("{:.2f}x", value);
    return ci95 ? fmt::format("{} [{:.2f}, {:.2f}]", text, (*ci95)[0], (*ci95)[1]) : text;
}

std::string ratio_text(const OrReason<report::Speedup>& speedup) {
    return speedup ? ratio_text(speedup->value, speedup->ci95) : "-";
}

Row no_result(const Result& result) {
    return {result.label, word_of(result.status) + ": " + result.reason};
}

Row row(const Result& result) {
    if (result.status != ResultStatus::ok) return no_result(result);
    Row cells = {result.label,
                 number(result, "timing.median", 2),
                 number(result, "timing.mad", 2),
                 number(result, "timing.p95", 2),
                 result.timing ? std::to_string(result.timing->outliers.size()) : "-",
                 ratio_text(result.speedup),
                 result.speedup ? word_of(result.speedup->verdict) : "-",
                 number(result, "timing.sort.median", 2),
                 ratio_text(result.speedup_with_sort)};
    for (const Quantity* metric : metric_columns())
        cells.push_back(number(metric->value(result), metric->terminal.decimals));
    return cells;
}

/// The error of the image format alone: the reference, rounded like the methods' target.
Row rounded_row(const report::Rounded& rounded) {
    Result result{.label = rounded.label};
    result.metrics.value = rounded.metrics;
    return row(result);
}

Row fragment_row(const Result& result) {
    if (result.status != ResultStatus::ok) return no_result(result);
    Row cells = {result.label};
    for (const char* name : {"submitted", "shaded", "visible", "needed", "live_warps"})
        cells.push_back(number(result, fmt::format("fragments.{}", name), 0));
    cells.push_back(number(result, "fragments.model_speedup", 2));
    cells.push_back(number(result, "fragments.efficiency", 2));
    return cells;
}

std::string fragment_table(const report::Run& run) {
    std::vector<Row> rows = {
        {"method", "submitted", "shaded", "visible", "needed", "live warps", "model ×", "efficiency"}};
    for (const Result& result : run.results) rows.push_back(fragment_row(result));
    return aligned(rows);
}

std::string time_table(const report::Run& run) {
    std::vector<Row> rows = {
        {"method", "median ms", "MAD", "p95", "outliers", "speedup [95 %]", "verdict", "sort ms", "with sort [95 %]"}};
    for (const Quantity* metric : metric_columns()) rows[0].push_back(metric->terminal.head);
    for (const Result& result : run.results) rows.push_back(row(result));
    if (run.reference.rounded) rows.push_back(rounded_row(*run.reference.rounded));
    return aligned(rows);
}

/// What the looks that methods bring change in them.
std::string change_lines(const report::Run& run) {
    std::string text;
    for (const Result& result : run.results) {
        if (!result.change) {
            if (!result.change.reason.empty())
                text += fmt::format("Change by {}: not known, as {}.\n", result.label, result.change.reason);
            continue;
        }
        const report::Change& change = *result.change;
        text += fmt::format("Change from {} to {}: the picture is ", change.from, result.label);
        text += change.is_identical
                    ? "identical"
                    : fmt::format("different, mean FLIP {}, {} pixels", number(result, "change.flip.mean", 4),
                                  number(result, "change.differing_pixels", 0));
        text += fmt::format("; speed {}{}.\n", ratio_text(change.speedup),
                            change.speedup ? ", " + word_of(change.speedup->verdict) : "");
    }
    return text;
}

bool sorts(const Result& result) {
    return result.timing && result.timing->sort;
}

/// What the columns mean, and how reliable the times are.
std::string captions(const report::Run& run, const std::string& baseline) {
    const report::Reference& reference = run.reference;
    std::string text = fmt::format("d: {} minus method, in 8-bit levels.", reference.method);
    if (reference.residual.depth_peeling)
        text += fmt::format(" Residual to depth peeling {}.", number_text(*reference.residual.depth_peeling, 2));
    if (reference.rounded) text += fmt::format("\n{}: the error of the image format alone.", reference.rounded->label);
    const auto [asked, done, needed, looks] = run.rounds;
    text += fmt::format("\nSpeedup over {}, {} of {} rounds{}.", baseline, done, asked,
                        done < asked ? ", ended by max_seconds" : "");
    if (looks > 1)
        text += fmt::format(
            " Checks were undecided, so their times were looked at {} times; the intervals of all looks "
            "together have 95 % confidence.",
            looks);
    if (done < needed) text += fmt::format(" Too few rounds: {}, needs {}; nothing is resolved.", done, needed);
    text += "\nIt is the median of the ratios round by round, not the ratio of the medians.";
    if (std::ranges::any_of(run.results, sorts))
        text +=
            "\nFrames are drawn in an order computed before timing. sort: the time to recompute it in each frame; with "
            "sort: the speedup including that.";
    text += "\n";
    if (run.noise_floor)
        text += fmt::format("Noise floor, {} against itself: {}.\n", baseline,
                            ratio_text(run.noise_floor->value, run.noise_floor->ci95));
    return text;
}

std::string note_lines(const std::vector<Note>& notes) {
    std::string text;
    for (const Note& note : notes)
        text += fmt::format("Note: {}{}{}\n", note.where, note.where.empty() ? "" : ": ", note.text);
    return text;
}

std::string published_text(const nlohmann::json& published) {
    if (published.is_number()) return number_text(published);
    return fmt::format("{} to {}", number_text(published[0]), number_text(published[1]));
}

/// Published beside measured figures, then the outcome of each trend.
std::string suite_text(const report::Suite& suite) {
    if (suite.figures.empty()) return fmt::format("\n{}\n", suite.source);
    std::vector<Row> rows = {{"at", "method", "metric", "published", "measured"}};
    for (const report::Figure& figure : suite.figures)
        rows.push_back({describe_point(figure.at), figure.method, figure.metric, published_text(figure.published),
                        figure.measured ? number_text(*figure.measured) : "-"});
    std::string text =
        fmt::format("\n{}\nPublished figures were measured on {}.\n\n{}\n", suite.source, suite.device, aligned(rows));
    for (const report::Trend& trend : suite.trends)
        text += fmt::format("{:<12}  {}: {}\n", word_of(trend.verdict), trend.text, trend.detail);
    return text;
}

std::string check_line(const report::Check& check) {
    const std::string point = describe_point(check.at);
    const std::string outcome = word_of(check.came_out());
    std::string line = fmt::format("{}  {} of {}{} is {}", outcome == "failed" ? "FAILED" : outcome, check.metric,
                                   check.method, point.empty() ? "" : " at " + point, check_value(check));
    if (check.min) line += ", at least " + full_number_text(*check.min);
    if (check.max) line += ", at most " + full_number_text(*check.max);
    if (!check.reason.empty()) line += ": " + check.reason;
    return line + "\n";
}

std::string device_line(const report::Device& device) {
    return fmt::format("{}, OpenGL {} ({})\n", device.renderer, device.gl_version, device.context);
}

}  // namespace

std::string report_table(const Report& report) {
    const report::Device device = report.device.value_or(report::Device{});
    std::string text = report.devices.empty() ? device_line(device) : "";
    for (const report::DevicePart& part : report.devices)
        text += fmt::format("{}: {}", part.label,
                            part.device ? device_line(*part.device) : "failed: " + part.reason + "\n");
    if (device.software)
        text += "Times on a software rasteriser do not predict those on a GPU; counts of fragments are closer.\n";
    text += note_lines(report.notes);
    for (const report::Run& run : report.runs) {
        text += "\n";
        if (!run.point.empty()) text += "At " + describe_point(run.point) + "\n";
        const std::string fragments = fragment_table(run), times = time_table(run);
        text += device.software ? fragments + "\n" + times : times + "\n" + fragments;
        text += "\n";
        text += captions(run, report.baseline());
        text += change_lines(run);
        if (run.frontier)
            for (const std::string& sentence : run.frontier->sentences) text += sentence + "\n";
    }
    if (report.suite) text += suite_text(*report.suite);
    text += sweep_table(report);
    text += across_table(report);
    if (!report.checks.empty()) text += "\n";
    for (const report::Check& check : report.checks) text += check_line(check);
    return text;
}

}  // namespace sheer
