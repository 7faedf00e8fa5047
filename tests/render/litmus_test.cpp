// Litmus scenes: every method on each of them, with the outcome that its theory predicts. The expectations are in the
// methods' rows, tests/render/methods/<id>.cpp, from which docs/litmus.md is made.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "renderer/litmus/scenes.h"
#include "tests/render/early_exit.h"
#include "tests/render/litmus_drawing.h"
#include "tests/render/litmus_page.h"
#include "tests/render/litmus_pairs.h"
#include "tests/render/method_row.h"
#include "tests/render/render_test.h"
#include "tests/source_folder.h"

namespace sheer::test::litmus_test {

namespace {

using nlohmann::json;

constexpr double passes_within = 3.0 / 255, fails_from = 6.0 / 255;
/// Each of 32 additions of 16-bit floats is off by up to 2^-11 of the sum, up or down.
constexpr double rounding_in_16_bits = 8 * 0x1p-10;

/// A litmus entry of a method's row.
struct Entry {
    const MethodRow* row;
    const LitmusEntry* litmus;
};

std::vector<Entry> all_entries() {
    std::vector<Entry> all;
    for (const MethodRow& row : all_method_rows())
        for (const LitmusEntry& entry : row.litmus) all.push_back({&row, &entry});
    return all;
}

bool is_one_drivers(const MethodRow& row) {
    return std::ranges::any_of(row.variants, &MethodVariant::software_only);
}

/// Infinite for a pixel that is not a number.
double difference(const Color& color, const float* pixel) {
    double greatest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        greatest = std::max(greatest, std::isfinite(pixel[i]) ? std::abs(color[i] - double{pixel[i]})
                                                              : std::numeric_limits<double>::infinity());
    return greatest;
}

/// 0 for methods that draw the same picture each time.
double noise_of(const MethodRow& row, const json& parameters, const Stack& stack) {
    return row.noise ? row.noise(parameters)(stack, PixelFormat::rgba32f) : 0;
}

class LitmusTest : public testing::Test {
  protected:
    Image picture(const LitmusScene& scene, const json& method) {
        const Spec spec = litmus_spec(scene, method, scene.in_16_bits ? PixelFormat::rgba16f : PixelFormat::rgba32f);
        return Stage(*m_context, spec, spec.image.format, litmus_geometry(scene)).picture(spec.methods[0]);
    }

    /// The greatest error of the picture, of a stochastic method that which is more than chance; also checks that the
    /// picture agrees with the method's formula.
    double error_of(const Image& image, const LitmusScene& scene, const MethodRow& row, const json& parameters) const {
        const Compositor truth = scene.truth(), seen = row.sorts_primitives ? scene.as_sorted() : truth;
        const Formula formula = row.formula(parameters);
        const bool has_formula = m_context->device().software || !(is_one_drivers(row) || scene.in_16_bits);
        double error = 0;
        for (int y = 0; y < litmus_size_px; ++y)
            for (int x = 0; x < litmus_size_px; ++x) {
                const float* pixel = image.pixel(x, y);
                const double by_chance = noise_of(row, parameters, truth.stack(x, y));
                error = std::max(error, difference(truth.pixel(x, y, scene.intended), pixel) - by_chance);
                if (!has_formula) continue;
                Color expected = seen.pixel(x, y, formula);
                for (double& channel : expected) channel = std::clamp(channel, 0.0, 1.0);
                const double by_rounding = scene.in_16_bits ? rounding_in_16_bits : 0;
                EXPECT_LE(difference(expected, pixel), row.litmus_tolerance + by_rounding + by_chance)
                    << fmt::format("pixel ({}, {}): expected {:.6g} {:.6g} {:.6g}, actual {:.6g} {:.6g} {:.6g}", x, y,
                                   expected[0], expected[1], expected[2], pixel[0], pixel[1], pixel[2]);
            }
        return error;
    }

    /// How much the picture differs from one order of submission to another.
    double change_by_order(const MethodRow& row, const json& parameters) {
        std::vector<Image> pictures;
        const Compositor truth = litmus_scene("shuffled_0").truth();
        for (const std::string& order : litmus_scene_infos().front().scene_ids) {
            const LitmusScene scene = litmus_scene(order);
            pictures.push_back(picture(scene, method_json(row, parameters)));
            error_of(pictures.back(), scene, row, parameters);
        }
        double greatest = 0;
        for (const Image& image : pictures)
            for (int y = 0; y < litmus_size_px; ++y)
                for (int x = 0; x < litmus_size_px; ++x) {
                    const float* first = pictures[0].pixel(x, y);
                    greatest = std::max(greatest, difference({first[0], first[1], first[2]}, image.pixel(x, y)) -
                                                      2 * noise_of(row, parameters, truth.stack(x, y)));
                }
        return greatest;
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

class Litmus : public LitmusTest, public testing::WithParamInterface<Entry> {
  protected:
    void expect(const LitmusExpectation& expectation, const std::string& scene_id, const json& parameters) {
        const MethodRow& row = *GetParam().row;
        const bool shuffled = scene_id == "shuffled";
        double error = 0;
        if (shuffled) {
            error = change_by_order(row, parameters);
        } else {
            const LitmusScene scene = litmus_scene(scene_id);
            error = error_of(picture(scene, method_json(row, parameters)), scene, row, parameters);
        }
        if (expectation.passes) {
            // Additions in another order round differently.
            EXPECT_LE(error, shuffled ? 1e-6 : passes_within) << expectation.why;
        } else {
            EXPECT_GE(error, fails_from) << expectation.why;
        }
    }
};

TEST_P(Litmus, AsItsTheoryPredicts) {
    for (const LitmusExpectation& expectation : GetParam().litmus->expectations)
        for (const std::string& scene : expectation.scenes)
            for (const json& parameters : GetParam().litmus->variants) {
                SCOPED_TRACE(GetParam().row->id + " " + parameters.dump() + " on " + scene);
                try {
                    expect(expectation, scene, parameters);
                } catch (const Unsupported& unsupported) {
                    GTEST_SKIP() << unsupported.what();
                }
            }
}

std::string entry_name(const testing::TestParamInfo<Entry>& entry) {
    std::string name = entry_name(*entry.param.row, *entry.param.litmus);
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

void PrintTo(const Entry& entry, std::ostream* out) {
    *out << entry_name(*entry.row, *entry.litmus);
}

INSTANTIATE_TEST_SUITE_P(All, Litmus, testing::ValuesIn(all_entries()), entry_name);

TEST(LitmusTable, HasEveryMethodOnEveryScene) {
    std::vector<std::string> all;
    for (const LitmusSceneInfo& scene : litmus_scene_infos()) all.push_back(scene.id);
    std::ranges::sort(all);
    for (const MethodRow& row : all_method_rows()) {
        EXPECT_FALSE(row.litmus.empty()) << row.id;
        for (const LitmusEntry& entry : row.litmus) {
            SCOPED_TRACE(entry_name(row, entry));
            EXPECT_FALSE(entry.variants.empty());
            std::vector<std::string> covered;
            for (const LitmusExpectation& expectation : entry.expectations) {
                EXPECT_FALSE(expectation.why.empty());
                covered.insert(covered.end(), expectation.scenes.begin(), expectation.scenes.end());
            }
            std::ranges::sort(covered);
            EXPECT_EQ(covered, all);
        }
    }
}

/// `./dev docs` sets SHEER_WRITE_DOCS, which rewrites it.
TEST(LitmusTable, IsWhatTheDocsSay) {
    const std::string path = source_folder() + std::string("/docs/litmus.md");
    const std::string page = litmus_page(litmus_scene_infos(), all_method_rows()) +
                             early_exit_section(all_method_rows()) + pairs_section(compare_formulas(all_method_rows()));
    if (std::getenv("SHEER_WRITE_DOCS") != nullptr) std::ofstream(path) << page;
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    EXPECT_EQ(text.str(), page) << "docs/litmus.md is out of date: ./dev docs rewrites it";
}

/// Formulas that differ on some scene by more than passes anywhere differ on one by as much as fails.
TEST(LitmusPairs, AreToldApartBySomeScene) {
    const FormulaPairs pairs = compare_formulas(all_method_rows());
    std::size_t entries = 0;
    for (std::size_t i = 0; i < pairs.groups.size(); ++i) {
        entries += pairs.groups[i].entries.size();
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GE(pairs.cells[i][k].difference, fails_from)
                << pairs.groups[i].entries[0] << " and " << pairs.groups[k].entries[0] << " on "
                << pairs.cells[i][k].scene;
    }
    EXPECT_EQ(entries, all_entries().size());
}

/// Those that are exact for each pixel, and those that sort primitives.
TEST(LitmusPairs, FormulasThatAreTheSameAreOneGroup) {
    const auto group_of = [](const FormulaPairs& pairs, const std::string& entry) {
        return std::ranges::find_if(
            pairs.groups, [&](const FormulaGroup& group) { return std::ranges::count(group.entries, entry) > 0; });
    };
    const FormulaPairs pairs = compare_formulas(all_method_rows());
    EXPECT_EQ(group_of(pairs, "exact"), group_of(pairs, "depth_peeling"));
    EXPECT_EQ(group_of(pairs, "b2f"), group_of(pairs, "f2bd"));
    EXPECT_NE(group_of(pairs, "exact"), group_of(pairs, "b2f"));
    const std::string section = pairs_section({{{{"x"}}, {{"y", "z"}}}, {{{}, {"white", 0.5}}, {{"white", 0.5}, {}}}});
    EXPECT_NE(section.find("| | formula | A | B |\n|---|---|---|---|\n| A | x | | 3 |\n| B | y; z | 3 | |\n"),
              std::string::npos)
        << section;
}

TEST(LitmusPage, SaysWhatTheRowsSay) {
    const std::vector<LitmusSceneInfo> scenes = {{"a", "First", "One."}, {"b", "Second", "Two."}};
    const MethodRow row = {.id = "f2b",
                           .litmus = {{"", {json::object()}, {{{"b"}, true, "it can"}, {{"a"}, false, "it cannot"}}}}};
    const std::string page = litmus_page(scenes, {row});
    for (const char* part : {"| 1 | First | One. |\n| 2 | Second | Two. |\n",
                             "| method | First | Second |\n|---|---|---|\n| f2b | **fails** | passes |\n",
                             "### f2b\nTested as `{\"id\":\"f2b\"}`.\n\n- Second: **passes**, because it can.\n"
                             "- First: **fails**, because it cannot.\n"})
        EXPECT_NE(page.find(part), std::string::npos) << part << " is not in " << page;
}

class LitmusDetails : public LitmusTest {};

/// Four layers of alpha 1, C0 farthest: truth minus `simple` is 3 D - C0 - C1 - C2 (slide 21), minus `full` it is
/// 6 D - C0 - C1 - C2 (slide 19).
TEST_F(LitmusDetails, MeshkinIsOffByTheTermsOfTheSlides) {
    const LitmusScene scene = litmus_scene("alpha_to_1");
    const int x = litmus_size_px - 1;
    const Stack stack = scene.truth().stack(x, 3);
    ASSERT_EQ(stack.fragments.size(), 4u);
    for (const double weight_of_d : {3.0, 6.0}) {
        const Image image = picture(scene, {{"id", "meshkin"}, {"variant", weight_of_d == 3 ? "simple" : "full"}});
        const float* pixel = image.pixel(x, 3);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& near_to_far = stack.fragments;
            const double truth = near_to_far[0].color[i];
            const double left_out = near_to_far[1].color[i] + near_to_far[2].color[i] + near_to_far[3].color[i];
            EXPECT_NEAR(truth - double{pixel[i]}, weight_of_d * stack.below[i] - left_out, 1e-6) << weight_of_d << i;
        }
    }
}

/// If all depths were 1, nothing would hide what is behind it.
TEST_F(LitmusDetails, NoPassKeepsTheDepthRangeOfThoseBefore) {
    const LitmusScene scene = litmus_scene("opaque_between");
    for (const MethodInfo& method : all_methods()) {
        const json only_id = {{"id", method.id}};
        m_context->gl().DepthRange(0, 1);
        try {
            const Image expected = picture(scene, only_id);
            m_context->gl().DepthRange(1, 1);
            EXPECT_EQ(greatest_difference(picture(scene, only_id), expected), 0) << method.id;
        } catch (const Unsupported&) {
            // The device lacks something that this method needs.
        }
    }
}

/// The layers after the eighth have no effect, and each frame keeps the share T of the previous frame's error.
TEST_F(LitmusDetails, StencilCapLosesLayersAndSettles) {
    LitmusScene scene = litmus_scene("64_layers");
    const json method = {{"id", "stencil_cap"}};
    const Image before = picture(scene, method);
    for (std::size_t i = 8; i < scene.surfaces.size(); ++i) scene.surfaces[i].color = {0.5, 1, 0};
    EXPECT_EQ(greatest_difference(picture(scene, method), before), 0);

    const double transmittance = std::pow(15.0 / 16, 8);
    const Color settled = {0.9, 0.2, 0.1};
    for (const int frames : {1, 2, 5, 30}) {
        const Image image = picture(scene, {{"id", "stencil_cap"}, {"frames", frames}});
        const float* pixel = image.pixel(4, 9);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(double{pixel[i]},
                        settled[i] + std::pow(transmittance, frames) * (scene.background[i] - settled[i]), 1e-5)
                << frames;
    }
}

}  // namespace

}  // namespace sheer::test::litmus_test
