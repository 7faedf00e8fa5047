// Meshkin's approximation compared with the numbers on his slides, and at the limits of its range.
#include <cmath>

#include "tests/render/render_test.h"

namespace sheer::test::meshkin_test {

namespace {

using nlohmann::json;

json layer(double depth, double gray, double alpha) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", {gray, gray, gray}}, {"alpha", alpha}};
}

json opaque(double depth, double gray) {
    json result = layer(depth, gray, 1);
    result["opaque"] = true;
    return result;
}

/// A column of the picture with its own layers: gray D behind, then C0 (farthest) to C3 (nearest), all of one alpha.
void add_column(json& layers, int column, const std::array<double, 5>& grays, double alpha) {
    for (std::size_t i = 0; i < grays.size(); ++i) {
        const double depth = 0.9 - 0.1 * static_cast<double>(i);
        json added = i == 0 ? opaque(depth, grays[i]) : layer(depth, grays[i], alpha);
        added["rect"] = {column / 8.0, 0, (column + 1) / 8.0, 1};
        layers.push_back(added);
    }
}

Image picture(const json& layers, const json& method, const std::string& format = "rgba32f", int size_px = 8) {
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, json::array({method}), size_px, format);
    Stage stage(*context, spec, spec.image.format);
    return stage.picture(spec.methods[0]);
}

json variant(const std::string& name) {
    return {{"id", "meshkin"}, {"variant", name}};
}

float gray_of(const json& layers, const json& method, const std::string& format = "rgba32f") {
    return picture(layers, method, format, 4).pixel(2, 1)[1];
}

/// A line of the tables of slides 19 and 21: true minus approximation is d D - c0 C0 - c1 C1 - c2 C2.
struct SlideRow {
    double alpha, d_simple, d_full, c0, c1, c2;
};
constexpr SlideRow slide_rows[] = {{0, 0, 0, 0, 0, 0},
                                   {0.25, 0.31640625, 0.375, 0.14453125, 0.109375, 0.0625},
                                   {0.5, 1.0625, 1.5, 0.4375, 0.375, 0.25},
                                   {0.75, 2.00390625, 3.375, 0.73828125, 0.703125, 0.5625},
                                   {1, 3, 6, 1, 1, 1}};

/// D, C0 .. C3 for which no result of any row leaves 0..1, even if one of them is raised by `step`.
constexpr std::array<double, 5> base = {0.1, 0.25, 0.25, 0.25, 0.25};
constexpr double step = 0.05;

/// The error is linear in D and C0 .. C3: the increase from raising one of them, divided by the step, is its
/// coefficient.
TEST(Meshkin, ErrorsAreThoseOfTheSlides) {
    for (const SlideRow& row : slide_rows) {
        json layers = json::array();
        add_column(layers, 0, base, row.alpha);
        for (int i = 0; i < 5; ++i) {
            std::array<double, 5> raised = base;
            raised[static_cast<std::size_t>(i)] += step;
            add_column(layers, i + 1, raised, row.alpha);
        }
        const Image truth = picture(layers, "exact");
        for (const std::string name : {"simple", "full"}) {
            SCOPED_TRACE(name + " " + std::to_string(row.alpha));
            const Image approximation = picture(layers, variant(name));
            const auto error = [&](int column) {
                return double{truth.pixel(column, 3)[0]} - approximation.pixel(column, 3)[0];
            };
            const double d = name == "simple" ? row.d_simple : row.d_full;
            const double expected[] = {d, -row.c0, -row.c1, -row.c2, 0};
            EXPECT_NEAR(error(0), d * base[0] - row.c0 * base[1] - row.c1 * base[2] - row.c2 * base[3], 1e-6);
            for (int i = 0; i < 5; ++i) EXPECT_NEAR((error(i + 1) - error(0)) / step, expected[i], 5e-5) << i;
        }
    }
}

/// The same in the formats that accumulate in 16 bits: sums of up to 4 are accurate to 2^-9, and in 8 bits D, which is
/// accurate to half a level, has a weight of up to 6.
TEST(Meshkin, ErrorsAreThoseOfTheSlidesIn16Bits) {
    for (const SlideRow& row : slide_rows) {
        json layers = json::array();
        add_column(layers, 0, base, row.alpha);
        for (const std::string format : {"rgba8", "rgba16f"}) {
            const float truth = picture(layers, "exact").pixel(0, 0)[0];
            const double c = row.c0 * base[1] + row.c1 * base[2] + row.c2 * base[3];
            EXPECT_NEAR(truth - picture(layers, variant("simple"), format).pixel(0, 0)[0], row.d_simple * base[0] - c,
                        0x1p-8 + 3.5 / 255);
            EXPECT_NEAR(truth - picture(layers, variant("full"), format).pixel(0, 0)[0], row.d_full * base[0] - c,
                        0x1p-8 + 3.5 / 255);
        }
    }
}

/// One layer of alpha 0.25 and gray 0.8 over 0.4: simple is right, 0.5; full is 0.25 * 0.8, short of 0.75 * 0.4.
TEST(Meshkin, OneLayer) {
    const json layers = {opaque(0.9, 0.4), layer(0.5, 0.8, 0.25)};
    EXPECT_NEAR(gray_of(layers, variant("simple")), 0.5, 1e-6);
    EXPECT_NEAR(gray_of(layers, variant("full")), 0.2, 1e-6);
}

/// Fragments of alpha 0 have no reciprocal and must not count in any sum or product.
TEST(Meshkin, AlphaZeroChangesNothing) {
    json layers = {opaque(0.9, 0.1), layer(0.5, 0.9, 0)};
    for (const std::string name : {"simple", "full"}) EXPECT_NEAR(gray_of(layers, variant(name)), 0.1, 1e-6) << name;
    layers = {opaque(0.9, 0.1), layer(0.5, 0.9, 0.5), layer(0.4, 0.3, 0.25)};
    for (const std::string name : {"simple", "full"}) {
        const float without = gray_of(layers, variant(name));
        json more = layers;
        more.push_back(layer(0.2, 1, 0));
        EXPECT_EQ(gray_of(more, variant(name)), without) << name;
    }
}

/// Sums may pass 1 on the way: S = A = 3, D = 0.5 and C = 0.5 give 0.5 + 1.5 - 1.5; clamped early they would give 1.
TEST(Meshkin, ClampsOnlyTheResult) {
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"}) {
        json layers = {opaque(0.9, 0.5)};
        for (int i = 0; i < 4; ++i) layers.push_back(layer(0.1 + 0.1 * i, 0.5, 0.75));
        EXPECT_NEAR(gray_of(layers, variant("simple"), format), 0.5, 2 / 255.0) << format;
        layers = {opaque(0.9, 1)};
        for (int i = 0; i < 4; ++i) layers.push_back(layer(0.1 + 0.1 * i, 0, 1));
        EXPECT_EQ(gray_of(layers, variant("simple"), format), 0) << "1 - 4, in " << format;
        layers = {opaque(0.9, 0)};
        for (int i = 0; i < 4; ++i) layers.push_back(layer(0.1 + 0.1 * i, 1, 1));
        EXPECT_EQ(gray_of(layers, variant("full"), format), 1) << "0 + 4, in " << format;
    }
}

/// A layer in front of an opaque one counts, one behind it does not.
TEST(Meshkin, OpaqueHidesWhatIsBehind) {
    for (const std::string name : {"simple", "full"}) {
        const json alone = {opaque(0.5, 0.2), layer(0.3, 0.8, 0.5)};
        json more = alone;
        more.push_back(layer(0.7, 1, 0.5));
        EXPECT_EQ(gray_of(alone, variant(name)), gray_of(more, variant(name))) << name;
    }
}

TEST(Meshkin, SubmissionDoesNotMatter) {
    const json layers = {opaque(0.9, 0.3), layer(0.6, 0.9, 0.3), layer(0.2, 0.1, 0.2), layer(0.4, 0.6, 0.125)};
    for (const std::string name : {"simple", "full"}) {
        const float expected = gray_of(layers, variant(name));
        for (const auto& order : {std::array{3, 2, 1, 0}, {2, 0, 3, 1}, {1, 3, 0, 2}}) {
            json shuffled = json::array();
            for (const int i : order) shuffled.push_back(layers[static_cast<std::size_t>(i)]);
            EXPECT_NEAR(gray_of(shuffled, variant(name)), expected, 1e-6) << name;
        }
    }
}

/// 300 layers of 1/255: the product underflows, the reciprocals overflow 16 bits. Neither may leave NaN behind.
TEST(Meshkin, FullStaysFinite) {
    json layers = {opaque(0.9, 0.5)};
    for (int i = 0; i < 300; ++i) layers.push_back(layer(0.5, 0.25, 1 / 255.0));
    // Without the terms that vanish: 0.5 + (0.25 - 0.5) * 300 / 255.
    EXPECT_NEAR(gray_of(layers, variant("full"), "rgba32f"), 0.5 - 0.25 * 300 / 255, 1e-4);
    // A sum of 300 roundings of at most 2^-12 each, for the colors and, weighted by D, for the alphas.
    EXPECT_NEAR(gray_of(layers, variant("full"), "rgba16f"), 0.5 - 0.25 * 300 / 255, 300 * 1.5 * 0x1p-12);
    EXPECT_FALSE(std::isnan(gray_of({opaque(0.9, 0.5), layer(0.5, 0.25, 1e-7)}, variant("full"), "rgba16f")));
}

/// An alpha e beside three of a: the sum of the reciprocals is 1/e + 3/a, which passes half floats from e = 1/65504 on,
/// and the product e a^3; their product is a^3 + 3 e a^2. D + S - D A - D (a^3 + 3 e a^2) + D e a^3, by hand.
TEST(Meshkin, FullKeepsReciprocalsBeyondHalfFloats) {
    constexpr double d = 0.5, a = 0.5, c = 0.3;
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"})
        for (const double e : {1e-3, 1.5e-5, 1e-5, 1e-6, 1e-9, 1e-20}) {
            const json layers = {opaque(0.9, d), layer(0.2, c, e), layer(0.3, c, a), layer(0.4, c, a),
                                 layer(0.5, c, a)};
            const double alphas = 3 * a + e, sums = c * alphas;
            const double expected = d + sums - d * alphas - d * (a * a * a + 3 * e * a * a) + d * e * a * a * a;
            EXPECT_NEAR(gray_of(layers, variant("full"), format), expected, format == "rgba32f" ? 1e-6 : 4e-3)
                << format << e;
        }
    // Alone it gives A C with no part of D, like any single layer: as in the formula, although its sum is 0 in half
    // floats.
    for (const std::string format : {"rgba16f", "rgba32f"})
        EXPECT_NEAR(gray_of({opaque(0.9, d), layer(0.2, c, 1e-9)}, variant("full"), format), 0, 1e-6) << format;
}

TEST(Meshkin, SaysItsMemory) {
    const auto context = make_context("egl");
    const Spec spec =
        make_spec({{"type", "layers"}, {"layers", {layer(0.5, 1, 0.5)}}}, {variant("simple"), variant("full")}, 16);
    Stage small(*context, spec, PixelFormat::rgba8), large(*context, spec, PixelFormat::rgba32f);
    EXPECT_EQ(small.make(spec.methods[0])->memory_bytes(), 16 * 16 * 8);
    EXPECT_EQ(small.make(spec.methods[1])->memory_bytes(), 16 * 16 * 16);
    EXPECT_EQ(large.make(spec.methods[0])->memory_bytes(), 16 * 16 * 16);
    EXPECT_EQ(large.make(spec.methods[1])->memory_bytes(), 16 * 16 * 24);
}

}  // namespace

}  // namespace sheer::test::meshkin_test
