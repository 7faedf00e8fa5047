// The worst part of a picture, worked out by hand.
#include "renderer/metrics/shared/worst_tile.h"

#include <gtest/gtest.h>

#include "metric_pictures.h"

namespace sheer::worst_tile_test {
namespace {

using test::constant;

/// A map of zeros with a rectangle of ones.
std::vector<float> with_ones(int width, int height, int left, int top, int right, int bottom) {
    std::vector<float> map(std::size_t(width) * height);
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) map[std::size_t(y) * width + x] = 1;
    return map;
}

void expect(const WorstTile& tile, double mean, int x, int y) {
    EXPECT_DOUBLE_EQ(tile.mean, mean);
    EXPECT_EQ(tile.x, x);
    EXPECT_EQ(tile.y, y);
}

TEST(WorstTile, IsTheOneWithTheGreatestMean) {
    expect(greatest_tile(with_ones(256, 192, 130, 70, 138, 78), 256, 192), 64.0 / 4096, 128, 64);
}

TEST(WorstTile, IsTheFirstOfSeveral) {
    expect(greatest_tile(with_ones(256, 64, 0, 0, 256, 64), 256, 64), 1, 0, 0);
}

/// 100 columns have tiles from 0 and from 36, so the last column is in the second, whose mean is 64 of 4096.
TEST(WorstTile, EndsWithThePicture) {
    expect(greatest_tile(with_ones(100, 64, 99, 0, 100, 64), 100, 64), 64.0 / 4096, 36, 0);
}

TEST(WorstTile, IsThePictureIfThatIsSmaller) {
    expect(greatest_tile({0.25f, 0.75f}, 2, 1), 0.5, 0, 0);
}

TEST(WorstTile, WithTheLeastMean) {
    std::vector<float> map(128 * 64, 1.0f);
    map[127] = 0;
    expect(least_tile(map, 128, 64), 4095.0 / 4096, 64, 0);
}

/// Only the lower right 64x64 pixels differ, by a constant: FLIP there is more than the mean of all, a quarter of it.
TEST(WorstTile, OfFlipAndSsim) {
    const Image reference = constant(128, 128, {128, 128, 128});
    Image other = reference;
    for (int y = 64; y < 128; ++y)
        for (int x = 64; x < 128; ++x)
            for (int c = 0; c < 3; ++c) other.pixel(x, y)[c] = 100.0f / 255;
    const auto found = test::values(reference, other);
    EXPECT_EQ(found["flip"]["worst_tile_at"], nlohmann::json::array({64, 64}));
    // Within the tile the difference of constants, 0.312392, but for its borders; outside only near it.
    EXPECT_NEAR(found["flip"]["worst_tile"], 0.312392, 0.05);
    EXPECT_LT(found["flip"]["mean"], found["flip"]["worst_tile"].get<double>() / 3);
    // 118 windows have tiles from 0 and from 54, and the first one's middle is the sixth pixel.
    EXPECT_EQ(found["ssim_tile"]["at"], nlohmann::json::array({59, 59}));
    EXPECT_LT(found["ssim_tile"]["worst"], found["ssim"].get<double>());
}

/// Of constants it is (2 r t + c1) / (r^2 + t^2 + c1) everywhere.
TEST(WorstTile, OfSsimOfConstants) {
    const auto found = test::values(constant(140, 80, {128, 128, 128}), constant(140, 80, {100, 100, 100}));
    const double expected = (2.0 * 128 * 100 + 6.5025) / (128 * 128 + 100 * 100 + 6.5025);
    EXPECT_NEAR(found["ssim_tile"]["worst"], expected, 1e-6);
    EXPECT_NEAR(found["ssim"], expected, 1e-6);
}

}  // namespace
}  // namespace sheer::worst_tile_test
