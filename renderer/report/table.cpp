#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "renderer/number_text.h"
#include "renderer/report/check_text.h"
#include "renderer/report/report.h"
#include "renderer/report/sweep_table.h"
#include "renderer/report/text_table.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

using Row = TableRow;

/// The number at `path` below `value`, or a dash where there is none.
std::string number(const json& value, const char* path, const char* format) {
    const json::json_pointer pointer(path);
    if (!value.is_object() || !value.contains(pointer) || !value[pointer].is_number()) return "-";
    return fmt::format(fmt::runtime(format), value[pointer].get<double>());
}

/// A ratio of times with its interval.
std::string interval(const json& ratio) {
    if (ratio.is_null()) return "-";
    if (ratio["ci95"].is_null()) return fmt::format("{:.2f}x", ratio["value"].get<double>());
    return fmt::format("{:.2f}x [{:.2f}, {:.2f}]", ratio["value"].get<double>(), ratio["ci95"][0].get<double>(),
                       ratio["ci95"][1].get<double>());
}

std::string verdict(const json& speedup) {
    return speedup.is_null() ? "-" : speedup["verdict"].get<std::string>();
}

std::string outlier_count(const json& timing) {
    return timing.is_null() ? "-" : std::to_string(timing["outliers"].size());
}

Row no_result(const json& result) {
    return {result["label"], result["status"].get<std::string>() + ": " + result["reason"].get<std::string>()};
}

Row row(const json& result) {
    if (result["status"] != "ok") return no_result(result);
    return {result["label"],
            number(result, "/timing/median", "{:.2f}"),
            number(result, "/timing/mad", "{:.2f}"),
            number(result, "/timing/p95", "{:.2f}"),
            outlier_count(result["timing"]),
            interval(result["speedup"]),
            verdict(result["speedup"]),
            number(result, "/timing/sort/median", "{:.2f}"),
            interval(result.value("speedup_with_sort", json())),
            number(result, "/metrics/signed/mean_abs", "{:.3f}"),
            number(result, "/metrics/signed/min", "{:.0f}"),
            number(result, "/metrics/signed/max", "{:.0f}"),
            number(result, "/metrics/psnr", "{:.1f}"),
            number(result, "/metrics/ssim", "{:.4f}"),
            number(result, "/metrics/flip/mean", "{:.4f}"),
            number(result, "/metrics/differing_pixels", "{:.0f}")};
}

/// What the image format alone costs: the reference, rounded as the methods' target is. Reports made before it was
/// measured have none.
Row rounded_row(const json& rounded) {
    return row({{"label", rounded["label"]},
                {"status", "ok"},
                {"timing", nullptr},
                {"speedup", nullptr},
                {"metrics", rounded["metrics"]}});
}

Row fragment_row(const json& result) {
    if (result["status"] != "ok") return no_result(result);
    return {result["label"],
            number(result, "/fragments/submitted", "{:.0f}"),
            number(result, "/fragments/shaded", "{:.0f}"),
            number(result, "/fragments/visible", "{:.0f}"),
            number(result, "/fragments/needed", "{:.0f}"),
            number(result, "/fragments/efficiency", "{:.2f}")};
}

std::string fragment_table(const json& run) {
    std::vector<Row> rows = {{"method", "submitted", "shaded", "visible", "needed", "efficiency"}};
    for (const json& result : run["results"]) rows.push_back(fragment_row(result));
    return aligned(rows);
}

std::string time_table(const json& run) {
    std::vector<Row> rows = {{"method", "median ms", "MAD", "p95", "outliers", "speedup [95 %]", "verdict", "sort ms",
                              "with sort [95 %]", "mean |d|", "min d", "max d", "PSNR dB", "SSIM", "FLIP",
                              "differing px"}};
    for (const json& result : run["results"]) rows.push_back(row(result));
    if (run["reference"].contains("rounded")) rows.push_back(rounded_row(run["reference"]["rounded"]));
    return aligned(rows);
}

bool sorts(const json& result) {
    return result["timing"].is_object() && result["timing"].value("sort", json()).is_object();
}

/// What the columns mean, and how far the times can be trusted.
std::string captions(const json& run, const std::string& baseline) {
    std::string text =
        fmt::format("d: {} minus method, in 8-bit levels.", run["reference"]["method"].get<std::string>());
    const json& residual = run["reference"]["residual"]["depth_peeling"];
    if (residual.is_number()) text += fmt::format(" Residual to depth peeling {}.", number_text(residual, 2));
    if (run["reference"].contains("rounded"))
        text += fmt::format("\n{}: what the image format alone costs.",
                            run["reference"]["rounded"]["label"].get<std::string>());
    const int done = run["rounds"]["done"], asked = run["rounds"]["asked"];
    text += fmt::format("\nSpeedup over {}, {} of {} rounds{}.", baseline, done, asked,
                        done < asked ? ", ended by max_seconds" : "");
    const int needed = run["rounds"].value("needed", 0);
    if (done < needed) text += fmt::format(" Too few rounds: {}, needs {}; nothing is resolved.", done, needed);
    text += "\nIt is the median of the ratios round by round, which differs from the ratio of the medians.";
    if (std::ranges::any_of(run["results"], sorts))
        text +=
            "\nFrames are drawn in an order made before. sort: what making it anew takes in each frame; with sort: "
            "with it.";
    text += "\n";
    if (!run["noise_floor"].is_null())
        text += fmt::format("Noise floor, {} against itself: {}.\n", baseline, interval(run["noise_floor"]));
    return text;
}

std::string note_lines(const json& notes) {
    std::string text;
    for (const json& note : notes) {
        text += "Note: ";
        if (!note["where"].is_null()) text += note["where"].get<std::string>() + ": ";
        text += note["text"].get<std::string>() + "\n";
    }
    return text;
}

std::string published_text(const json& published) {
    if (published.is_number()) return number_text(published);
    return fmt::format("{} to {}", number_text(published[0]), number_text(published[1]));
}

/// Published beside measured, then what became of each trend.
std::string suite_text(const json& suite) {
    std::vector<Row> rows = {{"at", "method", "metric", "published", "measured"}};
    for (const json& figure : suite["figures"])
        rows.push_back({describe_point(figure["at"]), figure["method"], figure["metric"],
                        published_text(figure["published"]),
                        figure["measured"].is_number() ? number_text(figure["measured"]) : "-"});
    std::string text =
        fmt::format("\n{}\nPublished figures were measured on {}.\n\n{}\n", suite["source"].get<std::string>(),
                    suite["device"].get<std::string>(), aligned(rows));
    for (const json& trend : suite["trends"])
        text += fmt::format("{:<12}  {}: {}\n", trend["verdict"].get<std::string>(), trend["text"].get<std::string>(),
                            trend["detail"].get<std::string>());
    return text;
}

std::string check_line(const json& check) {
    const std::string point = describe_point(check["at"]);
    const std::string outcome = check_outcome(check);
    std::string line = fmt::format("{}  {} of {}{} is {}", outcome == "failed" ? "FAILED" : outcome,
                                   check["metric"].get<std::string>(), check["method"].get<std::string>(),
                                   point.empty() ? "" : " at " + point, check_value(check));
    if (!check["min"].is_null()) line += ", at least " + full_number_text(check["min"]);
    if (!check["max"].is_null()) line += ", at most " + full_number_text(check["max"]);
    // Reports made before checks had reasons have none.
    if (const json reason = check.value("reason", json()); reason.is_string()) line += ": " + reason.get<std::string>();
    return line + "\n";
}

}  // namespace

std::string report_table(const json& report) {
    const json& device = report["device"];
    std::string text = fmt::format("{}, OpenGL {} ({})\n", device["renderer"].get<std::string>(),
                                   device["gl_version"].get<std::string>(), device["context"].get<std::string>());
    const bool software = device["software"].get<bool>();
    if (software)
        text += "Times on a software rasteriser do not predict those on a GPU; counts of fragments come nearer.\n";
    // Reports made before there were notes have none.
    text += note_lines(report.value("notes", json::array()));
    for (const json& run : report["runs"]) {
        text += "\n";
        if (!run["point"].empty()) text += "At " + describe_point(run["point"]) + "\n";
        const std::string fragments = fragment_table(run), times = time_table(run);
        text += software ? fragments + "\n" + times : times + "\n" + fragments;
        text += "\n";
        text += captions(run, report["spec"]["baseline"]);
        if (run["frontier"].is_object())
            for (const auto& sentence : run["frontier"]["sentences"]) text += sentence.get<std::string>() + "\n";
    }
    if (report.contains("suite")) text += suite_text(report["suite"]);
    text += sweep_table(report);
    if (!report["checks"].empty()) text += "\n";
    for (const json& check : report["checks"]) text += check_line(check);
    return text;
}

}  // namespace sheer
