#include <fmt/format.h>

#include "renderer/files/diff.h"
#include "renderer/report/text_table.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string text(const json& value) {
    if (value.is_null()) return "-";
    return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string number(const json& value, const char* format) {
    return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}

std::string ratio(const json& judged) {
    if (judged.is_null()) return "-";
    const std::string value = fmt::format("{:.2f}x", judged["value"].get<double>());
    if (judged["ci95"].is_null()) return value;
    return fmt::format("{} [{:.2f}, {:.2f}]", value, judged["ci95"][0].get<double>(), judged["ci95"][1].get<double>());
}

TableRow picture_row(const std::string& label, const json& picture) {
    if (picture["verdict"] == "not examined") return {label, "not examined: " + text(picture["reason"])};
    const json& worst = picture["worst_pixel"];
    return {label,
            picture["verdict"],
            number(picture["flip"]["mean"], "{:.4f}"),
            number(picture["flip"]["max"], "{:.4f}"),
            number(picture["differing_pixels"], "{:.0f}"),
            number(picture["greatest_levels"], "{:.0f}"),
            worst.is_array() ? fmt::format("{}, {}", worst[0].get<int>(), worst[1].get<int>()) : "-"};
}

std::string picture_table(const json& run) {
    std::vector<TableRow> rows = {
        {"picture", "verdict", "FLIP mean", "FLIP max", "differing px", "greatest d", "worst px"}};
    if (run["reference"]["picture"].is_object()) rows.push_back(picture_row("reference", run["reference"]["picture"]));
    for (const json& result : run["results"]) {
        if (result["picture"].is_object()) {
            rows.push_back(picture_row(result["label"], result["picture"]));
        } else {
            rows.push_back({result["label"],
                            fmt::format("{} in A, {} in B", text(result["status"]["a"]), text(result["status"]["b"]))});
        }
    }
    return aligned(rows);
}

std::string change_table(const json& run) {
    std::vector<TableRow> rows = {{"time", "A ms", "B ms", "A / B [95 %]", "to baseline [95 %]", "B is"}};
    std::string reasons;
    for (const json& result : run["results"]) {
        const json& time = result["time"];
        if (!time.is_object()) continue;
        rows.push_back({result["label"], number(time["a"]["median"], "{:.2f}"), number(time["b"]["median"], "{:.2f}"),
                        ratio(time["absolute"]), ratio(time["relative"]), text(time["verdict"])});
        if (time["reason"].is_string())
            reasons += fmt::format("{} is not resolved: {}.\n", text(result["label"]), text(time["reason"]));
    }
    return rows.size() == 1 ? "" : fmt::format("\n{}{}", aligned(rows), reasons);
}

std::string side_line(const char* name, const json& side) {
    return fmt::format("{}: {}sheer {} ({}), {}, {}\n", name, side["id"].is_null() ? "" : text(side["id"]) + ", ",
                       text(side["version"]), text(side["commit"]), text(side["created_at"]), text(side["renderer"]));
}

bool is_file(const json& value) {
    return value.is_object() && value.contains("name") && value.contains("sha256") && value.contains("bytes");
}

std::string difference_line(const json& one) {
    const json &a = one["a"], &b = one["b"];
    if (!is_file(a) && !is_file(b)) return fmt::format("{}: {} | {}\n", text(one["pointer"]), text(a), text(b));
    const auto content = [](const json& file) {
        return is_file(file) ? fmt::format("{} bytes, SHA-256 {}", text(file["bytes"]), text(file["sha256"])) : "-";
    };
    const json& either = is_file(a) ? a : b;
    return fmt::format("The file {} ({}): {} | {}\n", text(either["name"]), text(either["pointer"]), content(a),
                       content(b));
}

std::string only_in_text(const char* name, const json& only) {
    std::string lines;
    for (const json& label : only["methods"]) lines += fmt::format("Only in {}: the method {}.\n", name, text(label));
    for (const json& point : only["points"]) lines += fmt::format("Only in {}: {}.\n", name, describe_point(point));
    return lines;
}

std::string conclusion(const json& diff) {
    const json &pictures = diff["summary"]["pictures"], &times = diff["summary"]["times"];
    return fmt::format(
        "\nPictures: {} identical, {} different, {} not examined. Times of B: {} faster, {} slower, {} not resolved.\n",
        pictures["identical"].get<int>(), pictures["different"].get<int>(), pictures["not examined"].get<int>(),
        times["faster"].get<int>(), times["slower"].get<int>(), times["not resolved"].get<int>());
}

}  // namespace

std::string diff_table(const json& diff) {
    std::string lines = side_line("A", diff["a"]) + side_line("B", diff["b"]);
    for (const json& one : diff["differences"]) lines += difference_line(one);
    lines += only_in_text("A", diff["only_in"]["a"]) + only_in_text("B", diff["only_in"]["b"]);
    lines += diff["same_device"].get<bool>()
                 ? "Same device: B is faster or slower where its time and its ratio to the baseline's both say so.\n"
                 : "Different devices: B is faster or slower by its time alone.\n";
    for (const json& run : diff["runs"]) {
        if (!run["point"].empty()) lines += "\nAt " + describe_point(run["point"]);
        lines += fmt::format("\n{}{}", picture_table(run), change_table(run));
    }
    return lines + conclusion(diff);
}

}  // namespace sheer
