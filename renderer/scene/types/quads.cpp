// The scene of the SCCG 2010 paper, section 3: axis-aligned quads parallel to the projection plane, wholly visible, at
// random positions. The paper gives sizes for a window of 512 x 512 pixels; here they scale with the shorter side.
#include <algorithm>
#include <numeric>
#include <utility>

#include "renderer/core/random.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

namespace {

struct QuadDistribution {
    std::string name;
    double min_size, max_size;  // fraction of the shorter side
    double centre_spread;  // largest distance of the centre from the middle, fraction of a side; 0: anywhere visible
    bool full = false;
};

constexpr double small_size = 154.0 / 512, big_size = 307.0 / 512;

const std::vector<QuadDistribution>& distributions() {
    static const std::vector<QuadDistribution> all = {
        {"random", 26.0 / 512, 256.0 / 512, 0},  {"small", small_size, small_size, 0},
        {"big", big_size, big_size, 0},          {"full", 1, 1, 0, true},
        {"thick", small_size, small_size, 0.1},  {"medium", small_size, small_size, 0.2},
        {"scarce", small_size, small_size, 0.35}};
    return all;
}

std::vector<std::string> distribution_names() {
    std::vector<std::string> names;
    for (const auto& distribution : distributions()) names.push_back(distribution.name);
    return names;
}

/// Depths as a shuffled ladder, so that no two quads share one.
std::vector<float> shuffled_depths(std::size_t count, Random& random) {
    std::vector<std::size_t> ranks(count);
    std::iota(ranks.begin(), ranks.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) std::swap(ranks[i - 1], ranks[random.below(i)]);
    std::vector<float> depths;
    for (const std::size_t rank : ranks)
        depths.push_back(static_cast<float>((static_cast<double>(rank) + 0.5) / static_cast<double>(count)));
    return depths;
}

/// The lower edge of a span of `size` in 0..1.
double place(const QuadDistribution& distribution, double size, Random& random) {
    if (distribution.centre_spread == 0) return random.between(0, 1 - size);
    const double centre = 0.5 + random.between(-distribution.centre_spread, distribution.centre_spread);
    return std::clamp(centre - size / 2, 0.0, 1 - size);
}

Geometry build_quads(const nlohmann::json& scene, const ImageSpec& image, AssetReader&) {
    const auto name = scene.at("distribution").get<std::string>();
    const auto& distribution = *std::ranges::find(distributions(), name, &QuadDistribution::name);
    const auto count = scene.at("count").get<std::size_t>();
    const double shorter_px = std::min(image.width_px, image.height_px);
    Random random(scene.at("seed").get<std::uint64_t>());
    const std::vector<float> depths = shuffled_depths(count, random);
    Geometry geometry;
    geometry.parallel = true;
    for (std::size_t i = 0; i < count; ++i) {
        const double size_px = random.between(distribution.min_size, distribution.max_size) * shorter_px;
        const double width = distribution.full ? 1 : size_px / image.width_px;
        const double height = distribution.full ? 1 : size_px / image.height_px;
        const double x = place(distribution, width, random), y = place(distribution, height, random);
        glm::vec4 tint(1);
        for (int channel = 0; channel < 4; ++channel) tint[channel] = static_cast<float>(random.between(0.5, 1));
        const auto uv_turn = static_cast<unsigned>(random.below(8));
        geometry.add_rect(x, y, x + width, y + height, depths[i], tint, false, uv_turn);
    }
    return geometry;
}

}  // namespace

SceneInfo scene_quads() {
    return {
        .id = "quads",
        .name = "Quads",
        .summary = "Textured quads parallel to the screen at random positions: the paper's measurement scene.",
        .source = "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 3",
        .parameters =
            {Param::choice(
                 "distribution",
                 "sizes and places: random 26 to 256 px, small 154 px, big 307 px of 512, full the "
                 "whole window; thick, medium and scarce are small ones spread further and further from the centre",
                 "random", distribution_names()),
             Param::integer("count", "how many quads", "", 1024, 1, 65536),
             Param::integer("seed", "of the random generator", "", 1, 0, 4294967295.0)},
        .default_shading = shadings::sixteen_textures,
        .build = build_quads,
    };
}

}  // namespace sheer
