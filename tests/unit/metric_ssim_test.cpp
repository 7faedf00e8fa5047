#include <gtest/gtest.h>

#include "metric_pictures.h"

namespace sheer::metric_ssim_test {
namespace {

using test::constant;
using test::picture;

double ssim(const Image& reference, const Image& test) {
    return test::values(reference, test)["ssim"].get<double>();
}

struct Known {
    int width, height;
    double value;
};

class SsimOfBusyPictures : public testing::TestWithParam<Known> {};

// The mean of the values that ssim.js 3 gives for the three channels as gray pictures, with the options {ssim:
// "original", downsample: false}. Sizes: exactly one window, less and more than one tile.
TEST_P(SsimOfBusyPictures, AgreesWithSsimJs) {
    const auto [width, height, value] = GetParam();
    EXPECT_NEAR(ssim(picture(width, height, test::busy), picture(width, height, test::busy_distorted)), value, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(SsimJs, SsimOfBusyPictures,
                         testing::Values(Known{11, 11, 0.4492578897787678}, Known{48, 32, 0.5700516455053155},
                                         Known{150, 70, 0.5598026187511864}, Known{400, 140, 0.5707953866910741}));

TEST(Ssim, OfConstantPicturesIsTheLuminanceTerm) {
    // (2 x y + 6.5025) / (x^2 + y^2 + 6.5025); the structure term is C2 / C2.
    EXPECT_NEAR(ssim(constant(20, 20, {100, 100, 100}), constant(20, 20, {150, 150, 150})), 0.923092310, 1e-5);
    EXPECT_NEAR(ssim(constant(20, 20, {0, 0, 0}), constant(20, 20, {255, 255, 255})), 9.999e-5, 1e-7);
    EXPECT_NEAR(ssim(constant(20, 20, {100, 10, 7}), constant(20, 20, {150, 20, 7})),
                (0.923092310 + 0.802567608 + 1) / 3, 1e-5);
}

TEST(Ssim, OfOnePixelIsTheLuminanceTerm) {
    EXPECT_NEAR(ssim(constant(1, 1, {100, 100, 100}), constant(1, 1, {150, 150, 150})), 0.923092310, 1e-6);
}

TEST(Ssim, CutsTheWindowToANarrowPicture) {
    // One window of weights (0.3078, 0.3844, 0.3078), computed by hand.
    const auto one = picture(3, 1, [](int x, int) { return test::Levels{x * 100, x * 100, x * 100}; });
    const int levels[3] = {10, 90, 220};
    const auto two = picture(3, 1, [&](int x, int) { return test::Levels{levels[x], levels[x], levels[x]}; });
    EXPECT_NEAR(ssim(one, two), 0.986223250, 1e-6);
}

TEST(Ssim, OfAnInvertedPictureIsNegative) {
    const auto checks = [](int x, int y) { return (x + y) % 2 * 255; };
    const auto one = picture(16, 16, [&](int x, int y) {
        return test::Levels{checks(x, y), checks(x, y), checks(x, y)};
    });
    const auto two = picture(16, 16, [&](int x, int y) {
        return test::Levels{checks(x + 1, y), checks(x + 1, y), checks(x + 1, y)};
    });
    EXPECT_LT(ssim(one, two), -0.98);
}

}  // namespace
}  // namespace sheer::metric_ssim_test
