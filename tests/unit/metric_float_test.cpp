// The metrics of the float pictures, which show differences that rounding to 8 bits and a single background hide.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "metric_pictures.h"

namespace sheer::metric_float_test {
namespace {

using nlohmann::json;

Image grey(int width, int height, float value) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? 1 : value;
    return image;
}

json linear(const Image& reference, const Image& test) {
    return test::values(reference, test)["linear"];
}

TEST(LinearMetric, WorkedByHand) {
    const Image reference = grey(2, 1, 0.5f);
    Image other = reference;
    other.pixel(0, 0)[1] = 0.25f;
    other.pixel(1, 0)[2] = 2.5f;    // over 1: not clamped
    other.pixel(1, 0)[3] = 0.125f;  // alpha is ignored
    // 0.25 and 2 over six channels: 2.25 / 6, sqrt((0.0625 + 4) / 6), 2.
    EXPECT_EQ(linear(reference, other)["mean_abs"], 0.375);
    EXPECT_NEAR(linear(reference, other)["rmse"], 0.82285074, 1e-8);
    EXPECT_EQ(linear(reference, other)["max_abs"], 2.0);
    EXPECT_EQ(linear(other, reference), linear(reference, other));
}

TEST(LinearMetric, SeesDifferencesHiddenByRounding) {
    // A quarter of a level, and 1.25 shown as 1.
    const auto faint = test::values(grey(3, 3, 0), grey(3, 3, 0.25f / 255));
    EXPECT_EQ(faint["rmse"], 0.0);
    EXPECT_NEAR(faint["linear"]["rmse"], 0.25 / 255, 1e-9);
    const auto bright = test::values(grey(3, 3, 1), grey(3, 3, 1.25f));
    EXPECT_EQ(bright["rmse"], 0.0);
    EXPECT_EQ(bright["linear"]["rmse"], 0.25);
}

TEST(LinearMetric, IsThatOfTheLevelsForPicturesOfLevels) {
    const Image reference = test::picture(30, 20, test::busy), other = test::picture(30, 20, test::busy_distorted);
    const auto found = test::values(reference, other);
    EXPECT_NEAR(found["linear"]["rmse"].get<double>(), found["rmse"].get<double>(), 1e-7);
    EXPECT_NEAR(found["linear"]["mean_abs"].get<double>() * 255, found["signed"]["mean_abs"].get<double>(), 1e-5);
}

TEST(LinearMetric, IsNullWithAReasonIfNotFinite) {
    for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image other = grey(2, 2, 0);
        other.pixel(1, 1)[0] = broken;
        for (const json& found : {linear(grey(2, 2, 0), other), linear(other, grey(2, 2, 0)), linear(other, other)}) {
            for (const char* field : {"mean_abs", "rmse", "max_abs"}) EXPECT_TRUE(found[field].is_null()) << field;
            EXPECT_THAT(found["reason"].get<std::string>(), testing::HasSubstr("NaN"));
        }
    }
    const float greatest = std::numeric_limits<float>::max();
    EXPECT_EQ(linear(grey(2, 2, 0), grey(2, 2, greatest))["max_abs"], double{greatest}) << "sums do not overflow";
}

json over(const Backdrops& reference, const Backdrops& test) {
    return compute_metrics(reference.black, test.black, {.reference_over = &reference, .test_over = &test})
        .values["over_backgrounds"];
}

/// The reference lets nothing through; the method's C is right and its T is 0.25, which black does not show.
TEST(OverBackgrounds, WrongTransmittanceShowsOverWhite) {
    const Backdrops reference{grey(16, 16, 0.5f), grey(16, 16, 0.5f)}, test{grey(16, 16, 0.5f), grey(16, 16, 0.75f)};
    const json found = over(reference, test);
    EXPECT_EQ(found["black"], 0.0);
    EXPECT_EQ(found["white"], 0.25);
    // Half of the pixels lie on white squares: sqrt(0.0625 / 2).
    EXPECT_NEAR(found["checker"], 0.17677670, 1e-8);
    EXPECT_EQ(found["worst"], "white");
    EXPECT_EQ(found["rmse"], 0.25);
    EXPECT_EQ(found["max_abs"], 0.25);
}

/// 24 x 8 pixels: black, white, black squares. The error over black is on the first, that over white on the second.
TEST(OverBackgrounds, TheCheckerCanBeTheWorst) {
    const Backdrops reference{grey(24, 8, 0), grey(24, 8, 1)};
    Backdrops test = reference;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            test.black.pixel(x, y)[0] = 0.5f;
            test.white.pixel(x + 8, y)[0] = 0.25f;
        }
    const json found = over(reference, test);
    // A ninth of the channels is off by 0.5, by 0.75, and both.
    EXPECT_NEAR(found["black"], 0.5 / 3, 1e-9);
    EXPECT_NEAR(found["white"], 0.75 / 3, 1e-9);
    EXPECT_NEAR(found["checker"], std::sqrt((0.25 + 0.5625) / 9), 1e-9);
    EXPECT_EQ(found["worst"], "checker");
    EXPECT_EQ(found["rmse"], found["checker"]);
    EXPECT_EQ(found["max_abs"], 0.75);
}

TEST(OverBackgrounds, RowsOfSquaresAlternateAndTheLastMayBeCut) {
    // 10 x 10 pixels: the white squares are 2 x 8 on the right and 8 x 2 below, 32 pixels.
    const Backdrops reference{grey(10, 10, 0), grey(10, 10, 1)}, test{grey(10, 10, 0), grey(10, 10, 0.5f)};
    EXPECT_NEAR(over(reference, test)["checker"], std::sqrt(0.25 * 32 / 100), 1e-9);
}

TEST(OverBackgrounds, TheFirstOfEqualsIsTheWorstAndIdenticalPicturesHaveNone) {
    const Backdrops reference{grey(8, 8, 0), grey(8, 8, 1)}, test{grey(8, 8, 0.5f), grey(8, 8, 0.5f)};
    EXPECT_EQ(over(reference, test)["worst"], "black");
    EXPECT_EQ(over(reference, test)["rmse"], 0.5);
    EXPECT_TRUE(over(reference, reference)["worst"].is_null());
    EXPECT_EQ(over(reference, reference)["rmse"], 0.0);
}

TEST(OverBackgrounds, WithoutANumberThereIsAReason) {
    const Backdrops good{grey(8, 8, 0), grey(8, 8, 1)};
    Backdrops broken = good;
    broken.white.pixel(3, 3)[1] = std::numeric_limits<float>::quiet_NaN();
    const json found = over(good, broken);
    for (const char* field : {"worst", "rmse", "max_abs", "black", "white", "checker"})
        EXPECT_TRUE(found[field].is_null()) << field;
    EXPECT_THAT(found["reason"].get<std::string>(), testing::HasSubstr("over white"));
    const json without = test::values(good.black, good.black)["over_backgrounds"];
    EXPECT_TRUE(without["rmse"].is_null());
    EXPECT_THAT(without["reason"].get<std::string>(), testing::HasSubstr("not rendered"));
}

TEST(OverBackgrounds, OtherSizesAreRefused) {
    const Backdrops good{grey(8, 8, 0), grey(8, 8, 1)}, other{grey(8, 8, 0), grey(8, 7, 1)};
    EXPECT_THROW(over(good, other), std::invalid_argument);
    EXPECT_THROW(over(other, good), std::invalid_argument);
}

}  // namespace
}  // namespace sheer::metric_float_test
