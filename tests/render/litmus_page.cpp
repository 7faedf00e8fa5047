#include "tests/render/litmus_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace sheer::test {

namespace {

constexpr const char* head = R"(<!-- Made by ./dev docs from the descriptions in the source. -->
# Litmus scenes

What each method must get right and what, by its theory, it gets wrong, tested for every method by
`tests/render/litmus_test.cpp`. **passes**: no color of any pixel is off by more than three 8-bit levels. **fails**: some color
is off by six or more; the test also compares the picture with the prediction of the method's formula. The correct picture is
computed on the CPU in double precision; everything is rendered with `rgba32f` and default parameters unless the scene or the
variants say otherwise. A stochastic method is judged by its mean: what may be chance does not count.

`sheer litmus export DIR` writes the scenes for other renderers, and `sheer litmus identify DIR` names the formula behind their
pictures ([the command line](command-line.md#litmus)).

| | scene | what it is |
|---|---|---|
)";

bool is_about(const LitmusExpectation& expectation, const std::string& scene) {
    return std::ranges::find(expectation.scenes, scene) != expectation.scenes.end();
}

const char* outcome(bool passes) {
    return passes ? "passes" : "fails";
}

std::string table_row(const std::vector<LitmusSceneInfo>& scenes, const MethodRow& row, const LitmusEntry& entry) {
    std::string text = fmt::format("| {} |", entry_name(row, entry));
    for (const LitmusSceneInfo& scene : scenes) {
        const auto found = std::ranges::find_if(entry.expectations,
                                                [&](const LitmusExpectation& one) { return is_about(one, scene.id); });
        const bool passes = found != entry.expectations.end() && found->passes;
        text += passes ? " passes |" : " **fails** |";
    }
    return text + "\n";
}

std::string table(const std::vector<LitmusSceneInfo>& scenes, const std::vector<MethodRow>& rows) {
    std::string header = "| method |", line = "|---|";
    for (const LitmusSceneInfo& scene : scenes) {
        header += fmt::format(" {} |", scene.name);
        line += "---|";
    }
    std::string text = fmt::format("\n{}\n{}\n", header, line);
    for (const MethodRow& row : rows)
        for (const LitmusEntry& entry : row.litmus) text += table_row(scenes, row, entry);
    return text;
}

/// The names of the scenes, in the order of the table.
std::string scene_names(const std::vector<LitmusSceneInfo>& scenes, const LitmusExpectation& expectation) {
    std::vector<std::string> names;
    for (const LitmusSceneInfo& scene : scenes)
        if (is_about(expectation, scene.id)) names.push_back(scene.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string reasons(const std::vector<LitmusSceneInfo>& scenes, const MethodRow& row, const LitmusEntry& entry) {
    std::vector<std::string> variants;
    for (const nlohmann::json& parameters : entry.variants)
        variants.push_back(fmt::format("`{}`", method_json(row, parameters).dump()));
    std::string text = fmt::format("\n### {}\nTested as {}.\n\n", entry_name(row, entry), fmt::join(variants, ", "));
    for (const LitmusExpectation& one : entry.expectations)
        text += fmt::format("- {}: **{}**, because {}.\n", scene_names(scenes, one), outcome(one.passes), one.why);
    return text;
}

}  // namespace

std::string entry_name(const MethodRow& row, const LitmusEntry& entry) {
    return entry.name.empty() ? row.id : entry.name;
}

std::string litmus_page(const std::vector<LitmusSceneInfo>& scenes, const std::vector<MethodRow>& rows) {
    std::string page = head;
    for (std::size_t i = 0; i < scenes.size(); ++i)
        page += fmt::format("| {} | {} | {} |\n", i + 1, scenes[i].name, scenes[i].what);
    page += fmt::format("\n## Which method passes which\n{}\n## Why\n", table(scenes, rows));
    for (const MethodRow& row : rows)
        for (const LitmusEntry& entry : row.litmus) page += reasons(scenes, row, entry);
    return page;
}

}  // namespace sheer::test
