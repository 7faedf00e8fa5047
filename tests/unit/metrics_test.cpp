#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>
#include <stdexcept>

#include "metric_pictures.h"

namespace sheer::metrics_test {
namespace {

using test::busy;
using test::busy_distorted;
using test::constant;
using test::Levels;
using test::picture;
using test::values;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// 2x2 pictures whose differences, reference minus test, are (10, 0, 0), (0, -20, 0), (0, 0, 0) and (30, 0, -40).
Image small_reference() {
    const Levels levels[4] = {{110, 50, 60}, {70, 80, 90}, {1, 2, 3}, {230, 40, 0}};
    return picture(2, 2, [&](int x, int y) { return levels[y * 2 + x]; });
}

Image small_test() {
    const Levels levels[4] = {{100, 50, 60}, {70, 100, 90}, {1, 2, 3}, {200, 40, 40}};
    return picture(2, 2, [&](int x, int y) { return levels[y * 2 + x]; });
}

TEST(Metrics, WorkedByHand) {
    const auto found = values(small_reference(), small_test());
    EXPECT_DOUBLE_EQ(found["signed"]["mean_abs"], 100.0 / 12);
    EXPECT_EQ(found["signed"]["min"], -40);
    EXPECT_EQ(found["signed"]["max"], 30);
    // 100 + 400 + 900 + 1600 = 3000 over 12 channels: sqrt(250) / 255 and 20 log10(255) - 10 log10(250).
    EXPECT_NEAR(found["rmse"], 0.06200544, 1e-8);
    EXPECT_NEAR(found["psnr"], 24.1514035, 1e-7);
    EXPECT_EQ(found["differing_pixels"], 3);
    EXPECT_EQ(found["worst_pixel"], nlohmann::json::array({1, 1}));
    EXPECT_EQ(found["non_finite"], 0);
}

TEST(Metrics, SignedFollowsTheDirection) {
    const auto forth = values(small_reference(), small_test());
    const auto back = values(small_test(), small_reference());
    EXPECT_EQ(back["signed"]["min"], -30);
    EXPECT_EQ(back["signed"]["max"], 40);
    for (const char* same : {"rmse", "psnr", "ssim", "flip", "differing_pixels", "worst_pixel"})
        EXPECT_EQ(forth[same], back[same]) << same;
}

TEST(Metrics, SignedBoundsOfOneSidedDifferencesAreNotZero) {
    const auto found = values(constant(4, 3, {50, 60, 70}), constant(4, 3, {45, 57, 69}));
    EXPECT_EQ(found["signed"]["min"], 1);
    EXPECT_EQ(found["signed"]["max"], 5);
    EXPECT_DOUBLE_EQ(found["signed"]["mean_abs"], 3.0);
}

TEST(Metrics, PeakOfPsnrIsTheFormatsNotThePictures) {
    // All channels off by 51 levels = 0.2: -20 log10(0.2), however dark the picture is.
    const auto dark = values(constant(3, 3, {0, 0, 0}), constant(3, 3, {51, 51, 51}));
    const auto bright = values(constant(3, 3, {255, 255, 255}), constant(3, 3, {204, 204, 204}));
    EXPECT_NEAR(dark["psnr"], 13.9794, 1e-4);
    EXPECT_NEAR(bright["psnr"], 13.9794, 1e-4);
    EXPECT_NEAR(dark["rmse"], 0.2, 1e-12);
}

TEST(Metrics, SumsOfLargePicturesDoNotOverflow) {
    const auto found = values(constant(300, 100, {255, 255, 255}), constant(300, 100, {0, 0, 0}));
    EXPECT_DOUBLE_EQ(found["rmse"], 1.0);
    EXPECT_DOUBLE_EQ(found["psnr"], 0.0);
    EXPECT_DOUBLE_EQ(found["signed"]["mean_abs"], 255.0);
    EXPECT_EQ(found["differing_pixels"], 30000);
}

TEST(Metrics, IdenticalPictures) {
    const Image image = picture(140, 70, busy);
    const auto found = values(image, image);
    EXPECT_TRUE(found["psnr"].is_null());
    EXPECT_TRUE(found["worst_pixel"].is_null());
    EXPECT_EQ(found["ssim"], 1.0);
    EXPECT_EQ(found["rmse"], 0.0);
    EXPECT_EQ(found["differing_pixels"], 0);
    for (const auto& [field, value] : found["flip"].items()) {
        if (value.is_number()) {
            EXPECT_EQ(value, 0.0) << field;
        }
    }
    EXPECT_EQ(found["ssim_tile"]["worst"], 1.0);
    for (const auto& [field, value] : found["signed"].items()) EXPECT_EQ(value, 0) << field;
}

TEST(Metrics, WorstPixelIsTheFirstOfEquals) {
    const Image reference = constant(5, 4, {100, 100, 100});
    Image other = reference;
    other.pixel(4, 1)[0] = 130 / 255.0f;
    other.pixel(2, 2)[1] = 70 / 255.0f;
    other.pixel(0, 3)[2] = 120 / 255.0f;
    EXPECT_EQ(values(reference, other)["worst_pixel"], nlohmann::json::array({4, 1}));
    // Three small differences outweigh one larger.
    for (int c = 0; c < 3; ++c) other.pixel(0, 0)[c] = 111 / 255.0f;
    EXPECT_EQ(values(reference, other)["worst_pixel"], nlohmann::json::array({0, 0}));
}

TEST(Metrics, DifferencesBelowALevelDoNotCount) {
    const Image reference = constant(3, 3, {100, 100, 100});
    Image other = reference;
    other.pixel(1, 1)[0] += 0.3f / 255;
    other.pixel(1, 1)[3] = 0.5f;  // alpha is not compared
    EXPECT_EQ(values(reference, other)["differing_pixels"], 0);
}

TEST(Metrics, NonFiniteCountsPixelsInAnyChannel) {
    const Image reference = constant(4, 2, {9, 9, 9});
    Image other = reference;
    other.pixel(0, 0)[0] = nan;
    other.pixel(0, 0)[1] = infinity;
    other.pixel(3, 0)[2] = -infinity;
    other.pixel(2, 1)[3] = nan;
    EXPECT_EQ(values(reference, other)["non_finite"], 3);
    EXPECT_EQ(values(other, reference)["non_finite"], 0) << "only the method's picture counts";
}

TEST(Metrics, LargeFiniteValuesAreClampedAndFinite) {
    Image bright = constant(2, 1, {255, 255, 255});
    bright.pixel(0, 0)[0] = std::numeric_limits<float>::max();
    const auto found = values(constant(2, 1, {255, 255, 255}), bright);
    EXPECT_EQ(found["non_finite"], 0);
    EXPECT_EQ(found["differing_pixels"], 0);
}

class BrokenPixel : public testing::TestWithParam<float> {};

TEST_P(BrokenPixel, NeverScoresBetterThanAnyWrongColor) {
    for (const int level : {0, 100, 127, 128, 200, 255}) {
        const Image reference = constant(12, 12, {level, level, level});
        Image broken = reference;
        for (int c = 0; c < 3; ++c) broken.pixel(5, 5)[c] = GetParam();
        const auto with_nan = values(reference, broken);
        EXPECT_EQ(with_nan["worst_pixel"], nlohmann::json::array({5, 5}));
        EXPECT_EQ(with_nan["differing_pixels"], 1);
        for (int wrong = 0; wrong < 256; wrong += 51) {
            Image other = reference;
            for (int c = 0; c < 3; ++c) other.pixel(5, 5)[c] = float(wrong) / 255;
            const auto with_color = values(reference, other);
            EXPECT_GE(with_nan["signed"]["mean_abs"].get<double>(), with_color["signed"]["mean_abs"].get<double>());
            EXPECT_GE(with_nan["rmse"].get<double>(), with_color["rmse"].get<double>());
            if (!with_color["psnr"].is_null()) {
                EXPECT_LE(with_nan["psnr"].get<double>(), with_color["psnr"].get<double>());
            }
            EXPECT_GT(with_nan["flip"]["mean"].get<double>(), 0);
            EXPECT_LT(with_nan["ssim"].get<double>(), 1);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(NonFinite, BrokenPixel, testing::Values(nan, infinity, -infinity));

TEST(Metrics, BothPicturesBrokenIsStillADifference) {
    Image reference = constant(3, 3, {50, 50, 50});
    reference.pixel(1, 2)[0] = nan;
    const auto found = values(reference, reference);
    EXPECT_EQ(found["differing_pixels"], 1);
    EXPECT_EQ(found["non_finite"], 1);
    EXPECT_EQ(found["signed"]["min"], -255) << "the reference's NaN is black, the test's its opposite";
}

TEST(Metrics, RefusesPicturesThatCannotBeCompared) {
    EXPECT_THROW(compute_metrics(Image(4, 3), Image(3, 4)), std::invalid_argument);
    EXPECT_THROW(compute_metrics(Image(4, 3), Image(4, 4)), std::invalid_argument);
    EXPECT_THROW(compute_metrics(Image(), Image()), std::invalid_argument);
    Image cut(4, 3);
    cut.rgba.pop_back();
    EXPECT_THROW(compute_metrics(Image(4, 3), cut), std::invalid_argument);
    EXPECT_THROW(compute_metrics(cut, Image(4, 3)), std::invalid_argument);
}

TEST(Metrics, DifferencePictureShowsTheSign) {
    const Image reference = picture(4, 1, [](int x, int) { return Levels{x == 3 ? 255 : 100, 100, 100}; });
    const int red[4] = {100, 99, 104, 0};
    const Image other = picture(4, 1, [&](int x, int) { return Levels{red[x], 100, 100}; });
    const Image8 shown = test::picture_of(compute_metrics(reference, other), "difference");
    ASSERT_EQ(shown.width_px, 4);
    ASSERT_EQ(shown.height_px, 1);
    // 127 sqrt(1/255) = 7.95, 127 sqrt(4/255) = 15.9, 127 sqrt(255/255) = 127.
    EXPECT_THAT(shown.rgb, testing::ElementsAre(128, 128, 128, 136, 128, 128, 112, 128, 128, 255, 128, 128));
}

class TinyPictures : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(TinyPictures, GiveNumbersInRange) {
    const auto [width, height] = GetParam();
    const auto found = values(picture(width, height, busy), picture(width, height, [](int x, int y) {
                                  auto levels = busy_distorted(x, y);
                                  levels[0] = (levels[0] + 30) % 256;
                                  return levels;
                              }));
    EXPECT_EQ(found["differing_pixels"], width * height);
    EXPECT_GT(found["flip"]["mean"].get<double>(), 0);
    EXPECT_LE(found["flip"]["max"].get<double>(), 1);
    EXPECT_GT(found["psnr"].get<double>(), 0);
    EXPECT_LT(found["ssim"].get<double>(), 1);
    EXPECT_GT(found["ssim"].get<double>(), -1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, TinyPictures,
                         testing::Values(std::pair{1, 1}, std::pair{3, 1}, std::pair{1, 7}, std::pair{10, 10},
                                         std::pair{200, 2}));

/// Whether `value` is valid for a field of a report: a number or null, or the type of a field that is not a number.
bool fits(const MetricField& field, const nlohmann::json& value) {
    return !field.is_number() || value.is_number() || value.is_null();
}

TEST(AllMetrics, DescribeThemselves) {
    std::set<std::string> ids;
    for (const MetricInfo& metric : all_metrics()) {
        SCOPED_TRACE(metric.id);
        EXPECT_TRUE(ids.insert(metric.id).second);
        for (const std::string& text :
             {metric.id, metric.name, metric.summary, metric.source, metric.formula, metric.good_for})
            EXPECT_FALSE(text.empty());
        EXPECT_FALSE(metric.fields.empty());
        for (const MetricField& field : metric.fields) {
            EXPECT_FALSE(field.summary.empty());
            EXPECT_FALSE(field.range.empty());
        }
    }
}

TEST(AllMetrics, ValuesHaveTheFieldsTheyAnnounce) {
    const Backdrops reference{small_reference(), small_reference()}, test{small_test(), small_test()};
    const Metrics found =
        compute_metrics(small_reference(), small_test(), {.reference_over = &reference, .test_over = &test});
    EXPECT_EQ(found.values.size(), all_metrics().size());
    for (const MetricInfo& metric : all_metrics()) {
        SCOPED_TRACE(metric.id);
        const auto& value = found.values[metric.id];
        if (value.is_object()) {
            EXPECT_EQ(value.size() - (value.contains("reason") ? 1 : 0), metric.fields.size());
        }
        for (const MetricField& field : metric.fields) {
            SCOPED_TRACE(field.name);
            ASSERT_TRUE(field.name.empty() || value.contains(field.name));
            EXPECT_TRUE(fits(field, field.name.empty() ? value : value[field.name]));
        }
    }
}

TEST(AllMetrics, PicturesAreTheAnnouncedOnesAndOfThePairsSize) {
    const Metrics found = compute_metrics(small_reference(), small_test());
    std::set<std::string> announced, made;
    for (const MetricInfo& metric : all_metrics())
        if (!metric.picture.empty()) announced.insert(metric.picture);
    for (const auto& [key, image] : found.pictures) {
        made.insert(key);
        EXPECT_EQ(image.width_px, 2);
        EXPECT_EQ(image.height_px, 2);
        EXPECT_EQ(image.rgb.size(), 12u);
    }
    EXPECT_EQ(made, announced);
    EXPECT_THAT(made, testing::ElementsAre("difference", "flip"));
}

TEST(Quantize, RoundsHalvesUpAndClamps) {
    Image image(3, 1);
    const float red[3] = {-0.2f, 1.7f, nan};
    for (int x = 0; x < 3; ++x) image.pixel(x, 0)[0] = red[x];
    image.pixel(0, 0)[1] = 0.5f;  // 127.5
    image.pixel(1, 0)[1] = 127.4f / 255;
    image.pixel(2, 0)[1] = infinity;
    image.pixel(0, 0)[2] = 0.499f / 255;
    image.pixel(1, 0)[2] = 0.501f / 255;
    image.pixel(2, 0)[2] = -infinity;
    EXPECT_THAT(quantize(image).rgb, testing::ElementsAre(0, 128, 0, 255, 127, 1, 0, 255, 0));
}

TEST(Quantize, KeepsEveryLevelOfALongPicture) {
    const Image8 levels = quantize(picture(256, 3, [](int x, int y) { return Levels{x, 255 - x, (x + y) % 256}; }));
    for (int x = 0; x < 256; ++x) {
        EXPECT_EQ(levels.pixel(x, 2)[0], x);
        EXPECT_EQ(levels.pixel(x, 2)[1], 255 - x);
        EXPECT_EQ(levels.pixel(x, 2)[2], (x + 2) % 256);
    }
}

}  // namespace
}  // namespace sheer::metrics_test
