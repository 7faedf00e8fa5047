#include "renderer/compare/opacity.h"

#include <gtest/gtest.h>

namespace sheer::opacity_test {
namespace {

TEST(Opacity, IsWhatHidesTheBackground) {
    Backdrops over{Image(2, 1), Image(2, 1)};
    // Half of the background shows through red, a quarter through green, nothing through blue.
    over.black.rgba = {0.3f, 0.2f, 0.9f, 1, 0, 0, 0, 1};
    over.white.rgba = {0.8f, 0.45f, 0.9f, 1, 1, 1, 1, 1};
    const Image8 opacity = opacity_of(over);
    EXPECT_EQ(opacity.rgb, (std::vector<std::uint8_t>{128, 191, 255, 0, 0, 0}));
}

}  // namespace
}  // namespace sheer::opacity_test
