#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "metric_pictures.h"
#include "renderer/image/magma.h"
#include "renderer/metrics/shared/flip_map.h"
#include "tests/source_folder.h"

namespace sheer::metric_flip_test {
namespace {

using test::constant8;
using test::picture;

/// NVIDIA's tool works in single precision throughout; the measured differences from ours are less than 5e-5.
constexpr double tolerance = 0.001;

const std::string folder = std::string(source_folder()) + "/tests/data/flip/";

Image read_picture(const std::string& name) {
    const auto file = OIIO::ImageInput::open(folder + name);
    if (!file) throw std::runtime_error("cannot read " + folder + name);
    const int channels = file->spec().nchannels;
    Image image(file->spec().width, file->spec().height);
    std::vector<float> values(image.pixel_count() * std::size_t(channels));
    if (channels < 3 || !file->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()))
        throw std::runtime_error("cannot decode " + folder + name);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        std::copy_n(&values[i * std::size_t(channels)], 3, &image.rgba[i * 4]);
    return image;
}

TEST(Flip, AgreesWithTheReferenceTool) {
    const auto expected = nlohmann::json::parse(std::ifstream(folder + "expected.json"));
    const Image reference = read_picture(expected["reference"]);
    ASSERT_EQ(reference.width_px, 256);
    ASSERT_EQ(expected["pairs"].size(), 3u);
    for (const auto& pair : expected["pairs"]) {
        SCOPED_TRACE(pair["test"]);
        const Image other = read_picture(pair["test"]);
        const auto found = test::values(reference, other)["flip"];
        for (const char* field : {"mean", "weighted_median", "weighted_q1", "weighted_q3", "max"})
            EXPECT_NEAR(found[field].get<double>(), pair[field].get<double>(), tolerance) << field;
        const auto map = flip_map(quantize(reference), quantize(other));
        EXPECT_NEAR(*std::min_element(map.begin(), map.end()), pair["min"].get<double>(), tolerance);
    }
}

// The other metrics of the same pictures, computed in JavaScript (pngjs, ssim.js).
TEST(Metrics, OfRenderedPictures) {
    const auto found = test::values(read_picture("reference.png"), read_picture("test_threshold_0.25.png"));
    EXPECT_NEAR(found["signed"]["mean_abs"], 7.9652048746744795, 1e-12);
    EXPECT_EQ(found["signed"]["min"], -3);
    EXPECT_EQ(found["signed"]["max"], 46);
    EXPECT_NEAR(found["rmse"], 0.043090033793860325, 1e-12);
    EXPECT_EQ(found["differing_pixels"], 61039);
    EXPECT_NEAR(found["ssim"], 0.8776758650126548, 1e-6);
}

struct Colors {
    test::Levels one, two;
    double flip;
};

class FlipOfConstants : public testing::TestWithParam<Colors> {};

// Filters leave a constant picture unchanged, so only the color difference remains: computed in double precision from
// L*a*b*, Hunt's adjustment, HyAB and the remapping.
TEST_P(FlipOfConstants, IsTheColorDifference) {
    const auto& [one, two, flip] = GetParam();
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{5, 2}, std::pair{140, 70}})
        for (const float value : flip_map(constant8(width, height, one), constant8(width, height, two)))
            ASSERT_NEAR(value, flip, 2e-4) << width << "x" << height;
}

INSTANTIATE_TEST_SUITE_P(
    Worked, FlipOfConstants,
    testing::Values(Colors{{255, 255, 255}, {0, 0, 0}, 0.967380}, Colors{{0, 255, 0}, {0, 0, 255}, 1.0},
                    Colors{{128, 128, 128}, {100, 100, 100}, 0.312392}, Colors{{200, 30, 30}, {180, 60, 20}, 0.240124},
                    Colors{{255, 0, 0}, {0, 255, 0}, 0.986662}, Colors{{10, 10, 10}, {12, 12, 12}, 0.039261},
                    Colors{{5, 5, 5}, {1, 1, 1}, 0.061380}));

// Computed directly from the paper's formulas: filters in two dimensions, double precision, borders replicated.
TEST(Flip, OfPicturesSmallerThanItsFilters) {
    const auto map = [](int width, int height) {
        return flip_map(quantize(picture(width, height, test::busy)),
                        quantize(picture(width, height, test::busy_distorted)));
    };
    EXPECT_NEAR(map(1, 1)[0], 0.122324, 1e-4);
    const auto three = map(3, 1);
    EXPECT_NEAR(three[0], 0.219996, 1e-4);
    EXPECT_NEAR(three[1], 0.255039, 1e-4);
    EXPECT_NEAR(three[2], 0.237678, 1e-4);
    const auto block = map(12, 9);
    EXPECT_NEAR(block[0], 0.308094, 1e-4);
    EXPECT_NEAR(block[1], 0.330932, 1e-4);
    EXPECT_NEAR(*std::max_element(block.begin(), block.end()), 0.693100, 1e-4);
    double sum = 0;
    for (const float value : block) sum += value;
    EXPECT_NEAR(sum / double(block.size()), 0.454384, 1e-4);
}

TEST(Flip, IsSymmetricAndDoesNotDependOnTheThreads) {
    const Image8 one = quantize(picture(300, 150, test::busy));
    const Image8 two = quantize(picture(300, 150, test::busy_distorted));
    const auto map = flip_map(one, two, 1);
    EXPECT_EQ(map, flip_map(two, one, 1));
    EXPECT_EQ(map, flip_map(one, two, 2));
    EXPECT_EQ(map, flip_map(one, two, 5));
}

TEST(Flip, TilesLeaveNoSeam) {
    // A picture that repeats every 17 pixels has a map that repeats too, away from the borders, even across tiles.
    const auto repeat = [](const auto& level) { return [&](int x, int y) { return level(x % 17, y % 17); }; };
    const auto map = flip_map(quantize(picture(300, 160, repeat(test::busy))),
                              quantize(picture(300, 160, repeat(test::busy_distorted))));
    for (int y = 12; y < 160 - 12 - 17; ++y)
        for (int x = 12; x < 300 - 12 - 17; ++x) {
            const float value = map[std::size_t(y) * 300 + std::size_t(x)];
            ASSERT_NEAR(value, map[std::size_t(y) * 300 + std::size_t(x) + 17], 1e-4) << x << "," << y;
            ASSERT_NEAR(value, map[std::size_t(y + 17) * 300 + std::size_t(x)], 1e-4) << x << "," << y;
        }
}

TEST(Flip, PoolsAsItSays) {
    const Image one = picture(97, 61, test::busy);
    const Image two =
        picture(97, 61, [](int x, int y) { return x < 40 ? test::busy(x, y) : test::busy_distorted(x, y); });
    auto sorted = flip_map(quantize(one), quantize(two));
    std::sort(sorted.begin(), sorted.end());
    double total = 0;
    for (const float value : sorted) total += value;
    const auto weighted = [&](double share) {
        double sum = 0;
        for (const float value : sorted)
            if ((sum += value) >= share * total) return value;
        return sorted.back();
    };
    const auto found = test::values(one, two)["flip"];
    EXPECT_NEAR(found["mean"], total / double(sorted.size()), 1e-9);
    EXPECT_EQ(found["max"], sorted.back());
    // Nearest rank of 97 * 61 = 5917 pixels: ceil(5621.15) and ceil(5857.83).
    EXPECT_EQ(found["p95"], sorted[5622 - 1]);
    EXPECT_EQ(found["p99"], sorted[5858 - 1]);
    EXPECT_FLOAT_EQ(found["weighted_q1"], weighted(0.25));
    EXPECT_FLOAT_EQ(found["weighted_median"], weighted(0.5));
    EXPECT_FLOAT_EQ(found["weighted_q3"], weighted(0.75));
    EXPECT_LT(found["weighted_q1"], found["weighted_median"]);
    EXPECT_LT(found["p95"], found["p99"]);
}

TEST(Flip, PictureIsMagma) {
    const auto shown = [](test::Levels one, test::Levels two) {
        return test::picture_of(compute_metrics(test::constant(2, 1, one), test::constant(2, 1, two)), "flip").rgb;
    };
    EXPECT_THAT(shown({9, 9, 9}, {9, 9, 9}), testing::ElementsAre(0, 0, 4, 0, 0, 4));
    EXPECT_THAT(shown({0, 255, 0}, {0, 0, 255}), testing::ElementsAre(252, 253, 191, 252, 253, 191));
}

// Points of matplotlib's table that are not knots of ours.
TEST(Magma, IsWithinALevelOfTheOriginal) {
    const int original[2][4] = {{128, 183, 55, 121}, {51, 59, 15, 112}};
    for (const auto& point : original)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(magma()[std::size_t(point[0])][std::size_t(c)], point[c + 1], 1);
}

// Computed in double precision directly from both papers' formulas by another program, with filters in two dimensions,
// whose LDR-FLIP agrees with the values above: the exposures, the ACES curve and the greatest value of each pixel.
TEST(HdrFlip, OfPicturesOverWhite) {
    const auto four_times = [](int width, int height, const auto& level) {
        Image image = picture(width, height, level);
        for (float& value : image.rgba) value *= 4;
        return image;
    };
    const auto found =
        test::values(four_times(12, 9, test::busy), four_times(12, 9, test::busy_distorted)).at("hdr_flip");
    EXPECT_NEAR(found["mean"], 0.498885, 2e-4);
    EXPECT_NEAR(found["weighted_median"], 0.492061, 2e-4);
    EXPECT_NEAR(found["p99"], 0.691281, 2e-4);
    EXPECT_NEAR(found["max"], 0.697933, 2e-4);
    EXPECT_EQ(found["exposures"], 2);
}

TEST(HdrFlip, OfOnePixel) {
    const auto of = [](const std::array<float, 3>& one, const std::array<float, 3>& two) {
        Image reference(1, 1), other(1, 1);
        std::ranges::copy(one, reference.rgba.begin());
        std::ranges::copy(two, other.rgba.begin());
        return test::values(reference, other).at("hdr_flip");
    };
    EXPECT_NEAR(of({2, 2, 2}, {1.5f, 1.5f, 1.5f})["mean"], 0.225230, 2e-4);
    EXPECT_NEAR(of({3, 1, 0.5f}, {3, 1.2f, 0.5f})["mean"], 0.422277, 2e-4);
    EXPECT_EQ(of({2, 2, 2}, {2, 2, 2})["mean"], 0.0);
    EXPECT_TRUE(of({1, 1, 1}, {0, 0, 0})["mean"].is_null());
    EXPECT_EQ(of({1, 1, 1}, {0, 0, 0})["reason"], "no value is over 1: flip says it all");
    EXPECT_EQ(of({2, 2, 2}, {INFINITY, 2, 2})["reason"], "a picture has a NaN or an infinity");
}

}  // namespace
}  // namespace sheer::metric_flip_test
