#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/metric_pictures.h"

namespace sheer::metric_flicker_test {
namespace {

using nlohmann::json;

json flicker(const std::vector<Image8>& frames) {
    const Image any = test::constant(frames[0].width_px, frames[0].height_px, {9, 9, 9});
    return compute_metrics(any, any, {.test_frames = &frames}).values["flicker"];
}

TEST(Flicker, IsTheMeanAndThePercentileOfTheGreatestChangeOfAChannel) {
    // 200 changes: 197 of 0, one of 4, one of 30, one of 7. The 198th from below is 4.
    std::vector<Image8> frames(3, test::constant8(10, 10, {100, 100, 100}));
    frames[1].pixel(3, 4)[0] = 104;
    frames[1].pixel(3, 4)[1] = 97;
    frames[2].pixel(3, 4)[0] = 104;
    frames[2].pixel(3, 4)[1] = 97;
    frames[2].pixel(0, 0)[2] = 70;
    frames[2].pixel(9, 9)[1] = 107;
    const json found = flicker(frames);
    EXPECT_DOUBLE_EQ(found["mean"].get<double>(), (4.0 + 30 + 7) / 200);
    EXPECT_EQ(found["p99"], 4);
}

TEST(Flicker, OfEqualFramesIs0AndOfOppositeOnes255) {
    const Image8 black = test::constant8(4, 4, {0, 0, 0}), white = test::constant8(4, 4, {255, 255, 255});
    EXPECT_EQ(flicker({white, white, white}), json({{"mean", 0.0}, {"p99", 0}}));
    EXPECT_EQ(flicker({black, white, black}), json({{"mean", 255.0}, {"p99", 255}}));
}

TEST(Flicker, IsNullWithAReasonIfThereAreNoFrames) {
    const json one = flicker({test::constant8(4, 4, {1, 2, 3})});
    const json none = test::values(test::constant(4, 4, {1, 2, 3}), test::constant(4, 4, {1, 2, 3}))["flicker"];
    for (const json& found : {one, none}) {
        EXPECT_TRUE(found["mean"].is_null());
        EXPECT_TRUE(found["p99"].is_null());
        EXPECT_EQ(found["reason"], "only one frame was rendered");
    }
}

}  // namespace
}  // namespace sheer::metric_flicker_test
