#include "renderer/metrics/shared/flip_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>

#include "renderer/core/work_queue.h"
#include "renderer/metrics/shared/taps.h"

// The picture is processed in tiles small enough to stay in a core's cache: a tile is converted to an opponent space
// with a margin, filtered along rows, then along columns, and compared pixel by pixel. All filters are sums of products
// of a filter in x and one in y.

namespace sheer {
namespace {

constexpr double pixels_per_degree = 67;

constexpr int tile_width = 128;
constexpr int tile_height = 64;
constexpr int color_radius = 10;   // ceil(3 sqrt(0.04 / (2 pi^2)) * 67), the widest of the spatial filters
constexpr int narrow_radius = 6;   // beyond it the achromatic and red-green filters are below a millionth of their peak
constexpr int feature_radius = 9;  // ceil(3 * 0.5 * 0.082 * 67)
constexpr int margin = color_radius;
constexpr int source_width = tile_width + 2 * margin;
constexpr int source_height = tile_height + 2 * margin;

using Row = std::array<float, tile_width>;
using SourceRow = std::array<float, source_width>;

/// The paper's q_c, p_c and p_t.
constexpr float color_exponent = 0.7f;
constexpr float knee_in = 0.4f;
constexpr float knee_out = 0.95f;

/// sRGB (linear) to XYZ, IEC 61966-2-1 as exact fractions; rows scaled so that white is (1, 1, 1) under D65.
glm::dmat3 rgb_to_xyz_of_white() {
    const glm::dmat3 rows(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,  //
                          2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,    //
                          1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382);
    glm::dmat3 scaled;
    for (int r = 0; r < 3; ++r) scaled[r] = rows[r] / (rows[r].x + rows[r].y + rows[r].z);
    return scaled;  // [row][column], not GLM's order: only ever used by element
}

/// Everything that does not depend on the pictures.
struct Constants {
    std::array<float, 256> linear;     ///< sRGB level to linear 0..1
    float to_xyz[3][3], to_rgb[3][3];  ///< [row][column]
    Taps<narrow_radius> achromatic, red_green;
    Taps<color_radius> blue_yellow[2];
    float blue_yellow_weight[2];
    Taps<feature_radius> smooth, slope, curvature;
    float greatest_color_difference;
    Constants();

    float linear_of(std::uint8_t level) const { return linear[level]; }
    static float linear_of(float value) { return value; }
};

/// Standard deviation in pixels of exp(-pi^2 d^2 / b), d in degrees.
double deviation_px(double b) {
    return std::sqrt(b / 2) / std::numbers::pi * pixels_per_degree;
}

/// sqrt with no error state, so that it stays a single instruction in loops; the argument is never negative.
float root(float value) {
    return std::sqrt(std::max(value, 0.0f));
}

/// Cube root of 0.008..1.1 to float precision: a guess from the exponent bits and two of Halley's steps.
float cube_root(float value) {
    const float third_of_bits = float(std::bit_cast<std::int32_t>(value)) * (1.0f / 3.0f);
    float guess = std::bit_cast<float>(std::int32_t(third_of_bits) + 709921077);
    for (int step = 0; step < 2; ++step) {
        const float cube = guess * guess * guess;
        guess = guess * (cube + 2 * value) / (2 * cube + value);
    }
    return guess;
}

/// CIE 1976 compression of a tristimulus value relative to white.
float lab_curve(float value) {
    constexpr float delta = 6.0f / 29.0f;
    const float curved = cube_root(std::max(value, 0.008f));
    const float straight = value * (1 / (3 * delta * delta)) + 4.0f / 29.0f;
    return value > delta * delta * delta ? curved : straight;
}

struct Lab {
    float lightness, a, b;
};

/// Linear RGB in 0..1 to L*a*b*, the chroma scaled by lightness after Hunt.
Lab hunt_lab(const float (&m)[3][3], float red, float green, float blue) {
    const float x = lab_curve(m[0][0] * red + m[0][1] * green + m[0][2] * blue);
    const float y = lab_curve(m[1][0] * red + m[1][1] * green + m[1][2] * blue);
    const float z = lab_curve(m[2][0] * red + m[2][1] * green + m[2][2] * blue);
    const float lightness = 116 * y - 16;
    return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float hyab(const Lab& one, const Lab& two) {
    const float a = one.a - two.a;
    const float b = one.b - two.b;
    return std::abs(one.lightness - two.lightness) + root(a * a + b * b);
}

/// First and second derivative of a Gaussian; the positive taps sum to 1 and the negative ones to -1.
void derivative_taps(double sigma_px, Taps<feature_radius>& slope, Taps<feature_radius>& curvature) {
    std::array<double, feature_radius + 1> first{}, second{};
    double first_sum = 0, positive = 0, negative = 0;
    for (int k = 0; k <= feature_radius; ++k) {
        const double gaussian = std::exp(-k * k / (2 * sigma_px * sigma_px));
        first[k] = k * gaussian;
        second[k] = (k * k / (sigma_px * sigma_px) - 1) * gaussian;
        first_sum += first[k];
        (second[k] > 0 ? positive : negative) += second[k] * (k == 0 ? 1 : 2);
    }
    for (int k = 0; k <= feature_radius; ++k) {
        slope[k] = float(first[k] / first_sum);
        curvature[k] = float(second[k] / (second[k] > 0 ? positive : -negative));
    }
}

/// The blue-yellow filter is a1 sqrt(pi/b1) exp(-pi^2 d^2/b1) + a2 sqrt(pi/b2) exp(-pi^2 d^2/b2), d^2 = x^2 + y^2: the
/// weight of each normalised Gaussian, cut at the radius, in the sum.
void blue_yellow_weights(const double (&a)[2], const double (&b)[2], float (&weights)[2]) {
    double mass[2];
    for (int i = 0; i < 2; ++i) {
        double sum = 0;
        for (int k = -color_radius; k <= color_radius; ++k) {
            const double degrees = k / pixels_per_degree;
            sum += std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / b[i]);
        }
        mass[i] = a[i] * std::sqrt(std::numbers::pi / b[i]) * sum * sum;
    }
    for (int i = 0; i < 2; ++i) weights[i] = float(mass[i] / (mass[0] + mass[1]));
}

Constants::Constants() {
    for (int level = 0; level < 256; ++level) {
        const double encoded = level / 255.0;
        linear[level] = float(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    const glm::dmat3 forward = rgb_to_xyz_of_white();
    const glm::dmat3 backward = glm::inverse(forward);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            to_xyz[r][c] = float(forward[r][c]);
            to_rgb[r][c] = float(backward[r][c]);
        }
    constexpr double blue_yellow_a[2] = {34.1, 13.5};
    constexpr double blue_yellow_b[2] = {0.04, 0.025};
    achromatic = gaussian_taps<narrow_radius>(deviation_px(0.0047));
    red_green = gaussian_taps<narrow_radius>(deviation_px(0.0053));
    for (int i = 0; i < 2; ++i) blue_yellow[i] = gaussian_taps<color_radius>(deviation_px(blue_yellow_b[i]));
    blue_yellow_weights(blue_yellow_a, blue_yellow_b, blue_yellow_weight);
    const double feature_sigma_px = 0.5 * 0.082 * pixels_per_degree;
    smooth = gaussian_taps<feature_radius>(feature_sigma_px);
    derivative_taps(feature_sigma_px, slope, curvature);
    const float green_to_blue = hyab(hunt_lab(to_xyz, 0, 1, 0), hunt_lab(to_xyz, 0, 0, 1));
    greatest_color_difference = std::pow(green_to_blue, color_exponent);
}

/// What the comparison needs of a tile of one picture.
struct Perceived {
    std::array<Row, tile_height> lightness, a, b, edge, point;
};

/// Working memory of one thread.
struct Scratch {
    std::array<SourceRow, source_height> achromatic, red_green, blue_yellow;
    std::array<Row, source_height> achromatic_x, red_green_x, blue_yellow_x[2], smooth_x, slope_x, curvature_x;
    Perceived pictures[2];
};

struct Tile {
    int left, top, width, height;  ///< px; the part of it that is inside the picture
};

/// Opponent colors Y, X - Y and Y - Z, relative to white. They are YCxCz without its scales and offset, which
/// normalised filters do not change; Y is also the (Y + 16) / 116 that the feature filters see.
template <typename Picture>
void load(const Constants& constants, const Picture& image, const Tile& tile, Scratch& scratch) {
    const auto& m = constants.to_xyz;
    std::array<int, source_width> column;
    for (int x = 0; x < source_width; ++x) column[x] = std::clamp(tile.left + x - margin, 0, image.width_px - 1);
    for (int y = 0; y < tile.height + 2 * margin; ++y) {
        const auto* row = image.pixel(0, std::clamp(tile.top + y - margin, 0, image.height_px - 1));
        SourceRow red, green, blue;
        for (int x = 0; x < source_width; ++x) {
            const auto* rgb = row + column[x] * 3;
            red[x] = constants.linear_of(rgb[0]);
            green[x] = constants.linear_of(rgb[1]);
            blue[x] = constants.linear_of(rgb[2]);
        }
        for (int x = 0; x < source_width; ++x) {
            const float luminance = m[1][0] * red[x] + m[1][1] * green[x] + m[1][2] * blue[x];
            scratch.achromatic[y][x] = luminance;
            scratch.red_green[y][x] = m[0][0] * red[x] + m[0][1] * green[x] + m[0][2] * blue[x] - luminance;
            scratch.blue_yellow[y][x] = luminance - (m[2][0] * red[x] + m[2][1] * green[x] + m[2][2] * blue[x]);
        }
    }
}

template <int Radius>
void even_row(const SourceRow& from, const Taps<Radius>& taps, Row& to) {
    for (int x = 0; x < tile_width; ++x) to[x] = even_sum<Radius, 1>(&from[x + margin], taps);
}

void filter_rows(const Constants& constants, int rows, Scratch& scratch) {
    for (int y = 0; y < rows; ++y) {
        const SourceRow& luminance = scratch.achromatic[y];
        even_row<narrow_radius>(luminance, constants.achromatic, scratch.achromatic_x[y]);
        even_row<narrow_radius>(scratch.red_green[y], constants.red_green, scratch.red_green_x[y]);
        for (int i = 0; i < 2; ++i)
            even_row<color_radius>(scratch.blue_yellow[y], constants.blue_yellow[i], scratch.blue_yellow_x[i][y]);
        even_row<feature_radius>(luminance, constants.smooth, scratch.smooth_x[y]);
        even_row<feature_radius>(luminance, constants.curvature, scratch.curvature_x[y]);
        Row& slope = scratch.slope_x[y];
        for (int x = 0; x < tile_width; ++x)
            slope[x] = odd_sum<feature_radius, 1>(&luminance[x + margin], constants.slope);
    }
}

template <int Radius>
void even_column(const std::array<Row, source_height>& from, int y, const Taps<Radius>& taps, Row& to) {
    const float* centre = from[y + margin].data();
    for (int x = 0; x < tile_width; ++x) to[x] = even_sum<Radius, tile_width>(centre + x, taps);
}

/// Spatially filtered opponent colors back to linear RGB, into the gamut, and on to L*a*b*.
void color_row(const Constants& constants, const Scratch& scratch, int y, Perceived& to) {
    Row achromatic, red_green, blue_yellow, second;
    even_column<narrow_radius>(scratch.achromatic_x, y, constants.achromatic, achromatic);
    even_column<narrow_radius>(scratch.red_green_x, y, constants.red_green, red_green);
    even_column<color_radius>(scratch.blue_yellow_x[0], y, constants.blue_yellow[0], blue_yellow);
    even_column<color_radius>(scratch.blue_yellow_x[1], y, constants.blue_yellow[1], second);
    const auto& m = constants.to_rgb;
    for (int i = 0; i < tile_width; ++i) {
        const float luminance = achromatic[i];
        const float opposed =
            constants.blue_yellow_weight[0] * blue_yellow[i] + constants.blue_yellow_weight[1] * second[i];
        const float x = red_green[i] + luminance;
        const float z = luminance - opposed;
        const float red = std::clamp(m[0][0] * x + m[0][1] * luminance + m[0][2] * z, 0.0f, 1.0f);
        const float green = std::clamp(m[1][0] * x + m[1][1] * luminance + m[1][2] * z, 0.0f, 1.0f);
        const float blue = std::clamp(m[2][0] * x + m[2][1] * luminance + m[2][2] * z, 0.0f, 1.0f);
        const Lab lab = hunt_lab(constants.to_xyz, red, green, blue);
        to.lightness[y][i] = lab.lightness;
        to.a[y][i] = lab.a;
        to.b[y][i] = lab.b;
    }
}

/// The strength of edges and of points: the lengths of the first and second derivatives.
void feature_row(const Constants& constants, const Scratch& scratch, int y, Perceived& to) {
    Row slope_x, slope_y, curvature_x, curvature_y;
    even_column<feature_radius>(scratch.slope_x, y, constants.smooth, slope_x);
    even_column<feature_radius>(scratch.curvature_x, y, constants.smooth, curvature_x);
    even_column<feature_radius>(scratch.smooth_x, y, constants.curvature, curvature_y);
    const float* centre = scratch.smooth_x[y + margin].data();
    for (int x = 0; x < tile_width; ++x) slope_y[x] = odd_sum<feature_radius, tile_width>(centre + x, constants.slope);
    for (int x = 0; x < tile_width; ++x) {
        to.edge[y][x] = root(slope_x[x] * slope_x[x] + slope_y[x] * slope_y[x]);
        to.point[y][x] = root(curvature_x[x] * curvature_x[x] + curvature_y[x] * curvature_y[x]);
    }
}

template <typename Picture>
void perceive(const Constants& constants, const Picture& image, const Tile& tile, Scratch& scratch, Perceived& to) {
    load(constants, image, tile, scratch);
    filter_rows(constants, tile.height + 2 * margin, scratch);
    for (int y = 0; y < tile.height; ++y) {
        color_row(constants, scratch, y, to);
        feature_row(constants, scratch, y, to);
    }
}

/// The color difference in 0..1: the lower 40 % of the range are stretched over 95 % of it, since the largest
/// differences are rare and all clearly visible.
float remapped(float difference, float greatest) {
    const float knee = knee_in * greatest;
    if (difference < knee) return difference * (knee_out / knee);
    return std::min(knee_out + (difference - knee) / (greatest - knee) * (1 - knee_out), 1.0f);
}

void compare_row(const Constants& constants, const Perceived& one, const Perceived& two, int y, int width, float* out) {
    for (int x = 0; x < width; ++x) {
        const float distance =
            hyab({one.lightness[y][x], one.a[y][x], one.b[y][x]}, {two.lightness[y][x], two.a[y][x], two.b[y][x]});
        const float feature =
            std::max(std::abs(one.edge[y][x] - two.edge[y][x]), std::abs(one.point[y][x] - two.point[y][x]));
        const float color = remapped(std::pow(distance, color_exponent), constants.greatest_color_difference);
        const float sharpened = std::min(root(feature / std::numbers::sqrt2_v<float>), 1.0f);
        out[x] = std::pow(color, 1 - sharpened);
    }
}

template <typename Picture>
std::vector<float> map_of(const Picture& reference, const Picture& test, int max_threads) {
    static const Constants constants;
    std::vector<float> map(std::size_t(reference.width_px) * reference.height_px);
    const int columns = (reference.width_px + tile_width - 1) / tile_width;
    const int rows = (reference.height_px + tile_height - 1) / tile_height;
    const auto worker = [&](WorkQueue& queue) {
        const auto scratch = std::make_unique<Scratch>();
        auto& [one, two] = scratch->pictures;
        for (int index; queue.take(index);) {
            Tile tile{index % columns * tile_width, index / columns * tile_height, 0, 0};
            tile.width = std::min(tile_width, reference.width_px - tile.left);
            tile.height = std::min(tile_height, reference.height_px - tile.top);
            perceive(constants, reference, tile, *scratch, one);
            perceive(constants, test, tile, *scratch, two);
            for (int y = 0; y < tile.height; ++y) {
                const std::size_t first = std::size_t(tile.top + y) * reference.width_px + tile.left;
                compare_row(constants, one, two, y, tile.width, &map[first]);
            }
        }
    };
    share_work(columns * rows, worker, max_threads);
    return map;
}

}  // namespace

std::vector<float> flip_map(const Image8& reference, const Image8& test, int max_threads) {
    return map_of(reference, test, max_threads);
}

std::vector<float> flip_map(const LinearPicture& reference, const LinearPicture& test, int max_threads) {
    return map_of(reference, test, max_threads);
}

}  // namespace sheer
