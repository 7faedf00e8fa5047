// Pictures that methods drew on the device, in every way that people blend, and what the formulas on the CPU say of
// them.
#include <fmt/format.h>

#include <cmath>

#include "renderer/core/random.h"
#include "renderer/litmus/identify.h"
#include "tests/render/litmus_drawing.h"
#include "tests/render/method_row.h"
#include "tests/render/render_test.h"

namespace sheer::test::identify_test {

namespace {

using nlohmann::json;

const Identifier& identifier() {
    static const Identifier all;
    return all;
}

/// As a picture file of 8 bits has it.
Pixels in_8_bits(Pixels pixels) {
    for (Color& color : pixels)
        for (double& channel : color) channel = std::round(255 * std::clamp(channel, 0.0, 1.0)) / 255;
    return pixels;
}

/// What the device draws of a scene, if its colors are given to the method as `drawing` says.
Pixels drawn(gl::Context& context, LitmusScene scene, const Drawing& drawing, PixelFormat format) {
    const auto prepared = [&](Color color) {
        if (drawing.blending != Blending::encoded)
            for (double& channel : color) channel = srgb_to_linear(channel);
        return color;
    };
    scene.background = prepared(scene.background);
    for (LitmusSurface& surface : scene.surfaces) {
        surface.color = prepared(surface.color);
        if (drawing.colors == Colors::twice && !surface.opaque)
            for (double& channel : surface.color) channel *= surface.alpha;
    }
    if (drawing.order != litmus::Order::as_given)
        std::ranges::stable_sort(scene.surfaces, [&](const LitmusSurface& a, const LitmusSurface& b) {
            const double middle_a = a.left_depth + a.right_depth, middle_b = b.left_depth + b.right_depth;
            return drawing.order == litmus::Order::far_to_near ? middle_a > middle_b : middle_a < middle_b;
        });
    json method = drawing.parameters;
    method["id"] = drawing.formula->id;
    const Spec spec = litmus_spec(scene, method, format);
    const Image image = Stage(context, spec, format, litmus_geometry(scene)).picture(spec.methods[0]);
    Pixels pixels;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        pixels.push_back(as_shown({image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]}, drawing.blending));
    return pixels;
}

/// The formula's own picture, off by up to a level: for colors that are divided by alpha and so pass 1, at which
/// Sheer's methods clamp them.
Pixels disturbed(const LitmusScene& scene, const Drawing& drawing, Random& random) {
    Pixels pixels = Identifier::draw(scene, drawing);
    for (Color& color : pixels)
        for (double& channel : color) channel += random.between(-1, 1) / 255;
    return pixels;
}

std::map<std::string, Pixels> drawn_everywhere(gl::Context& context, const Drawing& drawing, PixelFormat format,
                                               Random& random) {
    std::map<std::string, Pixels> pictures;
    for (const LitmusScene& scene : all_litmus_scenes())
        pictures[scene.id] =
            in_8_bits(drawing.colors == Colors::premultiplied
                          ? disturbed(scene, drawing, random)
                          : drawn(context, scene, drawing, scene.in_16_bits ? PixelFormat::rgba16f : format));
    return pictures;
}

bool is_same(const Drawing& a, const Drawing& b) {
    return a.formula == b.formula && a.parameters == b.parameters && a.order == b.order && a.colors == b.colors &&
           a.blending == b.blending;
}

std::string text_of(const Drawing& drawing) {
    return fmt::format("{} {}, {}, {}, {}", drawing.formula->id, drawing.parameters.dump(), name_of(drawing.order),
                       name_of(drawing.colors), name_of(drawing.blending));
}

/// Those that this device draws: `samples` of 4 only.
std::vector<Drawing> drawable() {
    std::vector<Drawing> all = identifier().drawings();
    std::erase_if(all, [](const Drawing& drawing) { return drawing.parameters.value("samples", 4) != 4; });
    return all;
}

Drawing by_id(const std::string& id) {
    return *std::ranges::find_if(identifier().drawings(),
                                 [&](const Drawing& drawing) { return drawing.formula->id == id; });
}

/// SHEER_IDENTIFY_VARIANTS asks for more than are drawn in each run of the tests.
TEST(Identify, NamesTheFormulaOfSeededVariants) {
    const auto context = make_context("egl");
    const std::vector<Drawing> all = drawable();
    const char* const asked = std::getenv("SHEER_IDENTIFY_VARIANTS");
    const int variants = asked == nullptr ? 10 : std::stoi(asked);
    int right = 0;
    std::string wrong;
    for (int seed = 0; seed < variants; ++seed) {
        Random random(static_cast<std::uint64_t>(9000 + seed));
        const Drawing& drawing = all[random.below(all.size())];
        const auto format = random.below(2) == 0 ? PixelFormat::rgba16f : PixelFormat::rgba32f;
        const Identification found = identifier().identify(drawn_everywhere(*context, drawing, format, random));
        const bool is_named = found.found && std::ranges::any_of(found.drawings, [&](const Drawing& named) {
                                  return is_same(named, drawing);
                              });
        if (is_named) {
            ++right;
        } else {
            wrong += fmt::format(
                "{}: {} is taken for {} ({:.2f}, {:.2f} on {})\n", seed, text_of(drawing),
                found.found ? text_of(found.drawings.front()) : "none, nearest " + text_of(found.drawings.front()),
                found.fit.excess, found.fit.worst_excess, found.fit.worst_scene);
        }
    }
    RecordProperty("right", right);
    EXPECT_GE(right, 0.95 * variants) << wrong;
}

TEST(Identify, NamesNoneForAnotherFormula) {
    // Alphas are added up to 1, and the color is the brightest: no formula of the table.
    std::map<std::string, Pixels> pictures;
    for (const LitmusScene& scene : all_litmus_scenes()) {
        const Compositor compositor = scene.truth();
        for (int i = 0; i < litmus_size_px * litmus_size_px; ++i) {
            const Stack stack = compositor.stack(i % litmus_size_px, i / litmus_size_px);
            Color brightest = {};
            double alphas = 0;
            for (const Fragment& fragment : stack.fragments) {
                alphas += fragment.alpha;
                for (std::size_t k = 0; k < 3; ++k) brightest[k] = std::max(brightest[k], fragment.color[k]);
            }
            pictures[scene.id].push_back(mix(stack.below, brightest, std::min(alphas, 1.0)));
        }
    }
    const Identification found = identifier().identify(pictures);
    EXPECT_FALSE(found.found) << text_of(found.drawings.front());
    EXPECT_GT(found.fit.rms_levels, 6);
}

TEST(Identify, DoesWithSomeOfTheScenesAndSaysWhatTheyDoNotTellApart) {
    const LitmusScene scene = litmus_scene("one_layer");
    const Identification found = identifier().identify({{scene.id, Identifier::draw(scene, by_id("exact"))}});
    ASSERT_TRUE(found.found);
    // A single layer looks the same in any order, however it is weighted.
    for (const char* id : {"exact", "b2f", "unsorted", "wboit", "weighted_average"})
        EXPECT_TRUE(std::ranges::any_of(found.drawings, [&](const Drawing& one) {
            return one.formula->id == id && one.colors == Colors::straight && one.blending == Blending::encoded;
        })) << id;
    EXPECT_TRUE(
        std::ranges::none_of(found.drawings, [](const Drawing& one) { return one.formula->id == "alpha_test"; }));
    EXPECT_THROW(identifier().identify({{"none", {}}}), std::invalid_argument);
}

/// Worked out by hand: alpha 0.5 of 0.5 over 0, blended as linear values: 0.5 is 0.214041 in linear light, half of it
/// 0.107020, encoded 0.361; without encoding 0.107. Taken as premultiplied 0.5 is added whole; multiplied twice it is
/// 1/8.
TEST(Drawing, TakesColorsAndBlendingAsItsNamesSay) {
    const Stack stack{{0, 0, 0}, {{0.5f, 0.5, {0.5, 0.5, 0.5}}}};
    const auto value = [&](Colors colors, Blending blending) {
        const Drawing drawing{&find_formula("exact"), json::object(), litmus::Order::as_given, colors, blending};
        return as_shown(over_by_depth(submitted(stack, stack, drawing)), blending)[0];
    };
    EXPECT_NEAR(value(Colors::straight, Blending::encoded), 0.25, 1e-12);
    EXPECT_NEAR(value(Colors::straight, Blending::linear), 0.36085, 1e-4);
    EXPECT_NEAR(value(Colors::straight, Blending::linear_kept), 0.10702, 1e-5);
    EXPECT_NEAR(value(Colors::premultiplied, Blending::encoded), 0.5, 1e-12);
    EXPECT_NEAR(value(Colors::twice, Blending::encoded), 0.125, 1e-12);
}

/// Two fragments whose primitives' middles lie the other way round.
TEST(Drawing, SortsByTheMiddlesOfPrimitives) {
    const Stack stack{{0, 0, 0}, {{0.2f, 0.5, {1, 0, 0}}, {0.4f, 0.5, {0, 1, 0}}}};
    Stack by_middles = stack;
    by_middles.fragments[0].depth = 0.6f;
    const auto drawn_in = [&](litmus::Order order) {
        return over(submitted(stack, by_middles, {.formula = &find_formula("unsorted"), .order = order}));
    };
    EXPECT_EQ(drawn_in(litmus::Order::as_given), (Color{0.25, 0.5, 0}));
    EXPECT_EQ(drawn_in(litmus::Order::far_to_near), (Color{0.25, 0.5, 0}));
    EXPECT_EQ(drawn_in(litmus::Order::near_to_far), (Color{0.5, 0.25, 0}));
}

}  // namespace

}  // namespace sheer::test::identify_test
