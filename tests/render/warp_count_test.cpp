// Warps and quads, counted from rectangles and masks of pixels on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <set>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::warp_count_test {

namespace {

using nlohmann::json;

constexpr int size_px = 42;

/// A layer from pixel (left, top) up to but not including (right, bottom), counted from the top left.
struct Layer {
    int left, top, right, bottom;
    double alpha;

    bool covers(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
};

/// The first is the nearest.
json scene_of(const std::vector<Layer>& layers) {
    json all = json::array();
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto edge = [](int at) { return static_cast<double>(at) / size_px; };
        const Layer& layer = layers[i];
        all.push_back({{"rect", {edge(layer.left), edge(layer.top), edge(layer.right), edge(layer.bottom)}},
                       {"depth", 0.1 + 0.8 * static_cast<double>(i) / static_cast<double>(layers.size())},
                       {"color", {1, 1, 1}},
                       {"alpha", layer.alpha}});
    }
    return {{"type", "layers"}, {"layers", all}};
}

std::vector<FragmentCounts> counts_of(const std::vector<Layer>& layers, const json& methods) {
    const Spec spec = parse_spec({{"scene", scene_of(layers)},
                                  {"methods", methods},
                                  {"image", {{"width", size_px}, {"height", size_px}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    std::vector<FragmentCounts> counts;
    compare(
        spec, *context, assets, [](double, const std::string&) {},
        [&](const sheer::Run& run) {
            for (const MethodResult& result : run.results) counts.push_back(result.fragments);
        });
    return counts;
}

/// Blocks in which the layer has a pixel, and those in which `is_live` holds for one.
struct Expected {
    std::int64_t warps = 0, live_warps = 0, quads = 0, live_quads = 0;

    void add(const Layer& layer, const std::function<bool(int x, int y)>& is_live) {
        std::set<std::pair<int, int>> all_warps, warps_alive, all_quads, quads_alive;
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x) {
                if (!layer.covers(x, y)) continue;
                const std::pair warp{x / 8, y / 4}, quad{x / 2, y / 2};
                all_warps.insert(warp);
                all_quads.insert(quad);
                if (!is_live(x, y)) continue;
                warps_alive.insert(warp);
                quads_alive.insert(quad);
            }
        warps += std::ssize(all_warps);
        live_warps += std::ssize(warps_alive);
        quads += std::ssize(all_quads);
        live_quads += std::ssize(quads_alive);
    }
};

void expect_equal(const FragmentCounts& counts, const Expected& expected) {
    ASSERT_TRUE(counts.warps) << counts.no_warps_reason;
    EXPECT_EQ(counts.warps->warps, expected.warps);
    EXPECT_EQ(counts.warps->live_warps, expected.live_warps);
    EXPECT_EQ(counts.warps->quads, expected.quads);
    EXPECT_EQ(counts.warps->live_quads, expected.live_quads);
}

const json f2bd_each = {{"id", "f2bd"}, {"threshold", 0.1}, {"batch", 1}};

/// By hand: 40 x 40 px from the top left are 5 x 10 blocks of 8 x 4, and 400 of 2 x 2.
TEST(WarpCount, OfAFewLayersIsThatOnPaper) {
    // The nearest hides columns 0 to 5 from the other, which is left with two columns of its first blocks.
    const std::vector<FragmentCounts> counts =
        counts_of({{0, 0, 6, 40, 1}, {0, 0, 40, 40, 0.5}}, json::array({"b2f", f2bd_each, "f2bx"}));
    ASSERT_EQ(counts.size(), 3u);
    expect_equal(counts[0], {10 + 50, 10 + 50, 60 + 400, 60 + 400});
    expect_equal(counts[1], {10 + 50, 10 + 50, 60 + 400, 60 + 340});
    expect_equal(counts[2], {10 + 50, 0, 60 + 400, 0});
}

TEST(WarpCount, OfManyLayersIsThatOfTheCpu) {
    std::mt19937 random(7);
    std::vector<Layer> layers;
    for (int i = 0; i < 30; ++i) {
        const auto span = [&] {
            const auto [low, high] = std::minmax({static_cast<int>(random() % 41), static_cast<int>(random() % 41)});
            return std::pair{low, std::max(high, low + 1)};
        };
        const auto [left, right] = span();
        const auto [top, bottom] = span();
        layers.push_back({left, top, right, bottom, i % 3 == 0 ? 0.875 : 0.5});
    }
    Expected all, until_saturated;
    std::vector<double> transmittance(size_px * size_px, 1);
    for (const Layer& layer : layers) {
        const auto left_at = [&](int x, int y) -> double& { return transmittance[std::size_t(y) * size_px + x]; };
        all.add(layer, [](int, int) { return true; });
        until_saturated.add(layer, [&](int x, int y) { return left_at(x, y) >= 0.1; });
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x)
                if (layer.covers(x, y) && left_at(x, y) >= 0.1) left_at(x, y) *= 1 - layer.alpha;
    }
    const std::vector<FragmentCounts> counts = counts_of(
        layers, json::array({"b2f", "exact", f2bd_each, "weighted_average", {{"id", "f2bg"}, {"threshold", 0.1}}}));
    expect_equal(counts[0], all);
    expect_equal(counts[1], all);
    expect_equal(counts[2], until_saturated);
    expect_equal(counts[3], all);
    // A pixel's walk starts nothing that it does not shade.
    expect_equal(counts[4], {until_saturated.live_warps, until_saturated.live_warps, until_saturated.live_quads,
                             until_saturated.live_quads});
}

/// A primitive that is drawn twice fills warps twice.
TEST(WarpCount, OfTwoPassesIsTwice) {
    const std::vector<FragmentCounts> counts = counts_of({{0, 0, 40, 40, 0.5}, {8, 8, 16, 12, 0.5}}, {"mboit"});
    expect_equal(counts[0], {2 * 51, 2 * 51, 2 * 408, 2 * 408});
}

/// What opaque geometry hides does not start.
TEST(WarpCount, LeavesOutWhatTestsKeepFromStarting) {
    json scene = scene_of({{0, 0, 40, 40, 0.5}, {0, 0, 40, 40, 0.5}});
    scene["layers"].push_back(
        {{"rect", {0, 0, 16.0 / size_px, 1}}, {"depth", 0.3}, {"color", {1, 1, 1}}, {"alpha", 1}, {"opaque", true}});
    const Spec spec = parse_spec({{"scene", scene},
                                  {"methods", {"f2b"}},
                                  {"image", {{"width", size_px}, {"height", size_px}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    compare(
        spec, *context, assets, [](double, const std::string&) {},
        [&](const sheer::Run& run) {
            expect_equal(run.results[0].fragments, {50 + 30, 50 + 30, 400 + 240, 400 + 240});
        });
}

}  // namespace

}  // namespace sheer::test::warp_count_test
