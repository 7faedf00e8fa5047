#include "renderer/spec/litmus_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* head = R"(# Litmus scenes

What each method must get right and what its theory says that it gets wrong, tested for every method by
`tests/render/litmus_test.cpp`. **passes**: no colour of any pixel is off by more than three 8-bit levels. **fails**: some colour
is off by six or more; the test also holds the picture against what the method's formula predicts. The answer is worked out
on the CPU in double precision; all is rendered with `rgba32f`, with default parameters unless the variants say otherwise.

| scene | what it is |
|---|---|
)";

std::string string_at(const json& object, const char* key) {
    return object.at(key).get<std::string>();
}

bool is_about(const json& row, const std::string& scene) {
    const auto scenes = row.at("scenes").get<std::vector<std::string>>();
    return std::ranges::find(scenes, scene) != scenes.end();
}

std::string expectation(const json& entry, const std::string& scene) {
    for (const json& row : entry.at("rows"))
        if (is_about(row, scene)) return string_at(row, "expect");
    return "";
}

std::string table(const json& litmus) {
    std::string header = "| method |", line = "|---|";
    for (const json& scene : litmus.at("scenes")) {
        header += fmt::format(" {} |", string_at(scene, "name"));
        line += "---|";
    }
    std::string text = fmt::format("\n{}\n{}\n", header, line);
    for (const json& entry : litmus.at("methods")) {
        text += fmt::format("| {} |", string_at(entry, "name"));
        for (const json& scene : litmus.at("scenes")) {
            const bool passes = expectation(entry, string_at(scene, "id")) == "passes";
            text += passes ? " passes |" : " **fails** |";
        }
        text += "\n";
    }
    return text;
}

/// The names of a row's scenes, in the order of the table.
std::string scene_names(const json& litmus, const json& row) {
    std::vector<std::string> names;
    for (const json& scene : litmus.at("scenes"))
        if (is_about(row, string_at(scene, "id"))) names.push_back(string_at(scene, "name"));
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string reasons(const json& litmus, const json& entry) {
    std::vector<std::string> variants;
    for (const json& variant : entry.at("variants")) variants.push_back(fmt::format("`{}`", variant.dump()));
    std::string text = fmt::format("\n### {}\nTested as {}.\n\n", string_at(entry, "name"), fmt::join(variants, ", "));
    for (const json& row : entry.at("rows"))
        text += fmt::format("- {}: **{}**, because {}.\n", scene_names(litmus, row), string_at(row, "expect"),
                            string_at(row, "why"));
    return text;
}

}  // namespace

std::string litmus_page(const json& litmus) {
    std::string page = head;
    for (const json& scene : litmus.at("scenes"))
        page += fmt::format("| {} | {} |\n", string_at(scene, "name"), string_at(scene, "what"));
    page += fmt::format("\n## Which method passes which\n{}\n## Why\n", table(litmus));
    for (const json& entry : litmus.at("methods")) page += reasons(litmus, entry);
    return page;
}

}  // namespace sheer
