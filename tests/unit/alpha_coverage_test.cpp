#include "renderer/scene/alpha_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sheer::alpha_coverage_test {

namespace {

double share_of(const TextureLevel& level, int least) {
    std::size_t count = 0;
    for (std::size_t i = 3; i < level.rgba.size(); i += 4) count += level.rgba[i] >= least;
    return static_cast<double>(count) / static_cast<double>(level.rgba.size() / 4);
}

/// Leaves cover more than half of the picture, where plain means raise what is covered, and less of a picture of thin
/// things, where they lower it. One texel of a level of 64 x 64 is 1 / 4096 of it; rounding to 8 bits decides some.
TEST(AlphaCoverage, OfEachLevelIsThatOfThePicture) {
    for (const double alpha : {0.25, 0.5, 0.9}) {
        std::vector<TextureLevel> levels = make_texture("leaf", 256, 1);
        const int least = static_cast<int>(std::ceil(alpha * 255));
        const double whole = share_of(levels[0], least);
        const std::vector<std::uint8_t> picture = levels[0].rgba;
        keep_alpha_coverage(levels, alpha);
        EXPECT_EQ(levels[0].rgba, picture) << "the picture itself stays";
        for (const std::size_t level : {1u, 2u}) EXPECT_NEAR(share_of(levels[level], least), whole, 0.02) << alpha;
    }
}

/// Blades that are one texel of four wide: their mean has an alpha of 1/2, then 1/4, all under 0.6.
std::vector<Image> blades() {
    Image picture(128, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) picture.pixel(x, y)[3] = x % 4 == 0 ? 1.0f : 0.0f;
    return make_mipmaps(picture);
}

float greatest_alpha(const Image& level) {
    float greatest = 0;
    for (std::size_t i = 3; i < level.rgba.size(); i += 4) greatest = std::max(greatest, level.rgba[i]);
    return greatest;
}

TEST(AlphaCoverage, ThinThingsStayVisible) {
    std::vector<Image> levels = blades();
    EXPECT_FLOAT_EQ(greatest_alpha(levels[1]), 0.5f);
    EXPECT_FLOAT_EQ(greatest_alpha(levels[2]), 0.25f);
    keep_alpha_coverage(levels, 0.6);
    // 64 columns in pairs of 1/2 and 0: the quarter that is to be covered is half of those with 1/2.
    EXPECT_NEAR(greatest_alpha(levels[1]), 0.6f, 1e-6);
    // All alike: covered as a whole or not at all.
    EXPECT_NEAR(greatest_alpha(levels[2]), 0.6f, 1e-6);
}

TEST(AlphaCoverage, StaysWithin1AndLeavesWhatHasNone) {
    std::vector<Image> levels = blades();
    keep_alpha_coverage(levels, 1);
    for (const Image& level : levels) EXPECT_LE(greatest_alpha(level), 1.0f);

    Image faint(16, 8);
    for (std::size_t i = 3; i < faint.rgba.size(); i += 4) faint.rgba[i] = 0.25f;
    std::vector<Image> thin = make_mipmaps(faint);
    keep_alpha_coverage(thin, 0.5);
    for (const Image& level : thin) EXPECT_FLOAT_EQ(greatest_alpha(level), 0.25f);
}

}  // namespace

}  // namespace sheer::alpha_coverage_test
