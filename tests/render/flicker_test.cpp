// How much the pictures of methods change from frame to frame while nothing moves.
#include <gtest/gtest.h>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::flicker_test {

namespace {

using nlohmann::json;

/// One white layer of alpha 1/2 over black, everywhere.
json flicker_of(const json& method) {
    const json layer = {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {1, 1, 1}}, {"alpha", 0.5}};
    const Spec spec = parse_spec({{"scene", {{"type", "layers"}, {"layers", {layer}}}},
                                  {"methods", {method}},
                                  {"image", {{"width", 64}, {"height", 64}, {"background", {0, 0, 0}}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    json found;
    compare(
        spec, *context, assets, [](double, const std::string&) {},
        [&](const sheer::Run& run) { found = run.results.at(0).metrics->values["flicker"]; });
    return found;
}

TEST(Flicker, IsNoneWithoutNoise) {
    for (const char* method : {"b2f", "exact", "wboit", "stencil_cap"})
        EXPECT_EQ(flicker_of(method), json({{"mean", 0.0}, {"p99", 0}})) << method;
}

/// Of 4 samples k are covered, and of the next frame's l, each binomial (4, 1/2): the mean of |k - l| is 4 C(8, 4) /
/// 2^8 = 1.09375, and P(|k - l| > 3) = 2 / 256, so the 99th percentile is 3 of 4 samples. The deviation of the mean of
/// 3 x 4096 changes is less than 1 level.
TEST(Flicker, OfStochasticTransparencyIsThatOfIndependentFrames) {
    const json found = flicker_of({{"id", "stochastic"}, {"masks", "independent"}});
    EXPECT_NEAR(found["mean"].get<double>(), 1.09375 / 4 * 255, 4);
    EXPECT_NEAR(found["p99"].get<double>(), 3.0 / 4 * 255, 1);
}

/// Rounded up or down from 2 of 4 samples there is nothing to round, so that only other samples are covered.
TEST(Flicker, OfStratifiedMasksIsNoneAtAWholeNumberOfSamples) {
    EXPECT_EQ(flicker_of("stochastic")["mean"], 0.0);
}

/// The thresholds are fixed to the object. A mean of 4 frames that moves on by one replaces one of them, which differs
/// from the new one with a probability of 1/2: by a quarter of 255.
TEST(Flicker, OfHashedAlphaIsThatOfItsMovingMean) {
    EXPECT_EQ(flicker_of("hashed_alpha")["mean"], 0.0);
    const json found = flicker_of({{"id", "hashed_alpha"}, {"frames", 4}, {"hash", "position_and_primitive"}});
    EXPECT_NEAR(found["mean"].get<double>(), 0.5 * 255 / 4, 2);
    EXPECT_NEAR(found["p99"].get<double>(), 255.0 / 4, 1);
}

}  // namespace

}  // namespace sheer::test::flicker_test
