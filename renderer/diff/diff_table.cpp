#include <fmt/format.h>

#include "renderer/diff/diff.h"
#include "renderer/params/json_text.h"
#include "renderer/report/text_table.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string text(const json& value) {
    if (value.is_null()) return "-";
    return value.is_string() ? value.get<std::string>() : json_line(value);
}

std::string text_or_dash(const std::string& value) {
    return value.empty() ? "-" : value;
}

std::string ratio(const diff::Judged* judged) {
    if (!judged) return "-";
    const std::string value = fmt::format("{:.2f}x", judged->value);
    if (!judged->ci95) return value;
    return fmt::format("{} [{:.2f}, {:.2f}]", value, (*judged->ci95)[0], (*judged->ci95)[1]);
}

TableRow picture_row(const std::string& label, const diff::PictureDiff& picture) {
    if (picture.verdict == diff::PictureVerdict::not_examined) return {label, "not examined: " + picture.reason};
    const auto& worst = picture.worst_pixel.place;
    const auto flip = picture.flip.value_or(diff::FlipError{});
    return {label,
            word_of(picture.verdict),
            fmt::format("{:.4f}", flip.mean),
            fmt::format("{:.4f}", flip.max),
            std::to_string(picture.differing_pixels.value_or(0)),
            std::to_string(picture.greatest_levels.value_or(0)),
            worst ? fmt::format("{}, {}", (*worst)[0], (*worst)[1]) : "-"};
}

std::string picture_table(const diff::RunDiff& run) {
    std::vector<TableRow> rows = {
        {"picture", "verdict", "FLIP mean", "FLIP max", "differing px", "greatest d", "worst px"}};
    if (run.reference.picture) rows.push_back(picture_row("reference", *run.reference.picture));
    for (const diff::ResultDiff& result : run.results) {
        if (result.picture) {
            rows.push_back(picture_row(result.label, *result.picture));
        } else {
            rows.push_back(
                {result.label, fmt::format("{} in A, {} in B", word_of(result.status.a), word_of(result.status.b))});
        }
    }
    return aligned(rows);
}

std::string change_table(const diff::RunDiff& run) {
    const auto median = [](const diff::TimesOf& times) {
        return times.median ? fmt::format("{:.2f}", *times.median) : "-";
    };
    std::vector<TableRow> rows = {{"time", "A ms", "B ms", "A / B [95 %]", "to baseline [95 %]", "B is"}};
    std::string reasons;
    for (const diff::ResultDiff& result : run.results) {
        if (!result.time) continue;
        const diff::TimeDiff& time = *result.time;
        rows.push_back({result.label, median(time.a), median(time.b), ratio(time.absolute ? &*time.absolute : nullptr),
                        ratio(time.relative ? &*time.relative : nullptr), word_of(time.verdict)});
        if (!time.reason.empty()) reasons += fmt::format("{} is not resolved: {}.\n", result.label, time.reason);
    }
    return rows.size() == 1 ? "" : fmt::format("\n{}{}", aligned(rows), reasons);
}

std::string side_line(const char* name, const diff::Side& side) {
    return fmt::format("{}: {}sheer {} ({}), {}, {}\n", name, side.id.empty() ? "" : side.id + ", ",
                       text_or_dash(side.version), text_or_dash(side.commit), text_or_dash(side.created_at),
                       text_or_dash(side.renderer));
}

bool is_file(const json& value) {
    return value.is_object() && value.contains("name") && value.contains("sha256") && value.contains("bytes");
}

std::string difference_line(const diff::Difference& one) {
    const json &a = one.a, &b = one.b;
    if (!is_file(a) && !is_file(b))
        return fmt::format("{}{}: {} | {}\n", one.pointer, one.allowed ? " (allowed)" : "", text(a), text(b));
    const auto content = [](const json& file) {
        return is_file(file) ? fmt::format("{} bytes, SHA-256 {}", text(file["bytes"]), text(file["sha256"])) : "-";
    };
    const json& either = is_file(a) ? a : b;
    return fmt::format("The file {} ({}): {} | {}\n", text(either["name"]), text(either["pointer"]), content(a),
                       content(b));
}

std::string only_in_text(const char* name, const diff::OnlyIn& only) {
    std::string lines;
    for (const std::string& label : only.methods) lines += fmt::format("Only in {}: the method {}.\n", name, label);
    for (const json& point : only.points) lines += fmt::format("Only in {}: {}.\n", name, describe_point(point));
    return lines;
}

std::string conclusion(const diff::Summary& summary) {
    return fmt::format(
        "\nPictures: {} identical, {} different, {} not examined. Times of B: {} faster, {} slower, {} not resolved.\n",
        summary.pictures.identical, summary.pictures.different, summary.pictures.not_examined, summary.times.faster,
        summary.times.slower, summary.times.not_resolved);
}

}  // namespace

std::string diff_table(const diff::Diff& diff) {
    std::string lines = side_line("A", diff.a) + side_line("B", diff.b);
    for (const diff::Difference& one : diff.differences) lines += difference_line(one);
    lines += only_in_text("A", diff.only_in.a) + only_in_text("B", diff.only_in.b);
    lines +=
        diff.same_device
            ? "Same device: B is called faster or slower if both its time and its ratio to the baseline's say so.\n"
            : "Different devices: B is called faster or slower by its time alone.\n";
    for (const diff::RunDiff& run : diff.runs) {
        if (!run.point.empty()) lines += "\nAt " + describe_point(run.point);
        lines += fmt::format("\n{}{}", picture_table(run), change_table(run));
    }
    return lines + conclusion(diff.summary);
}

}  // namespace sheer
