#include "tests/render/litmus_pairs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/render/litmus_page.h"

namespace sheer::test {

namespace {

constexpr double same_within = 3.0 / 255;

using Pixels = std::vector<Color>;

Pixels pixels_of(const LitmusScene& scene, const MethodRow& row, const Formula& formula) {
    const Compositor compositor = row.sorts_primitives ? scene.as_sorted() : scene.truth();
    Pixels pixels;
    for (int y = 0; y < litmus_size_px; ++y)
        for (int x = 0; x < litmus_size_px; ++x) {
            Color color = compositor.pixel(x, y, formula);
            for (double& channel : color) channel = std::clamp(channel, 0.0, 1.0);
            pixels.push_back(color);
        }
    return pixels;
}

/// Of every litmus scene, in their order; the shuffled one in each of its orders.
std::vector<Pixels> pictures_of(const MethodRow& row, const nlohmann::json& parameters) {
    const Formula formula = row.formula(parameters);
    std::vector<Pixels> pictures;
    for (const LitmusSceneInfo& info : litmus_scene_infos()) {
        pictures.emplace_back();
        for (const std::string& id : info.scene_ids)
            std::ranges::copy(pixels_of(litmus_scene(id), row, formula), std::back_inserter(pictures.back()));
    }
    return pictures;
}

double greatest_difference_of(const Pixels& a, const Pixels& b) {
    double greatest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            greatest = std::max(greatest, std::abs(a[i][channel] - b[i][channel]));
    return greatest;
}

FormulaPairs::Cell most_different(const std::vector<Pixels>& a, const std::vector<Pixels>& b) {
    FormulaPairs::Cell most;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = greatest_difference_of(a[i], b[i]);
        if (difference > most.difference) most = {litmus_scene_infos()[i].id, difference};
    }
    return most;
}

std::string name_of(const FormulaGroup& group) {
    return fmt::format("{}", fmt::join(group.entries, "; "));
}

/// A to Z, AA to AZ, BA, ...
std::string letters_of(std::size_t group) {
    const std::string last(1, static_cast<char>('A' + group % 26));
    return group < 26 ? last : letters_of(group / 26 - 1) + last;
}

std::size_t number_of(const std::string& scene_id) {
    const auto& infos = litmus_scene_infos();
    return static_cast<std::size_t>(std::ranges::find(infos, scene_id, &LitmusSceneInfo::id) - infos.begin()) + 1;
}

}  // namespace

FormulaPairs compare_formulas(const std::vector<MethodRow>& rows) {
    FormulaPairs pairs;
    std::vector<std::vector<Pixels>> pictures;  // of each group's first entry
    for (const MethodRow& row : rows)
        for (const LitmusEntry& entry : row.litmus) {
            std::vector<Pixels> own = pictures_of(row, entry.variants.front());
            const auto same = std::ranges::find_if(pictures, [&](const std::vector<Pixels>& known) {
                return most_different(known, own).difference <= same_within;
            });
            if (same != pictures.end()) {
                pairs.groups[static_cast<std::size_t>(same - pictures.begin())].entries.push_back(
                    entry_name(row, entry));
                continue;
            }
            pairs.groups.push_back({{entry_name(row, entry)}});
            pictures.push_back(std::move(own));
        }
    for (const std::vector<Pixels>& a : pictures) {
        pairs.cells.emplace_back();
        for (const std::vector<Pixels>& b : pictures) pairs.cells.back().push_back(most_different(a, b));
    }
    return pairs;
}

std::string pairs_section(const FormulaPairs& pairs) {
    std::string text =
        "\n## Which scene tells two formulas apart\n"
        "For each pair the number of the scene on which their pictures differ most: by at least six 8-bit levels, by "
        "their "
        "formulas.\nFormulas in one line differ on no scene by more than three.\n\n| | formula |";
    std::string line = "|---|---|";
    for (std::size_t i = 0; i < pairs.groups.size(); ++i) {
        text += fmt::format(" {} |", letters_of(i));
        line += "---|";
    }
    text += "\n" + line + "\n";
    for (std::size_t i = 0; i < pairs.groups.size(); ++i) {
        text += fmt::format("| {} | {} |", letters_of(i), name_of(pairs.groups[i]));
        for (std::size_t k = 0; k < pairs.groups.size(); ++k)
            text += i == k ? " |" : fmt::format(" {} |", number_of(pairs.cells[i][k].scene));
        text += "\n";
    }
    return text;
}

}  // namespace sheer::test
