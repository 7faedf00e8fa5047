// A report's data on one pixel: values and counts read from the report's pictures.
#include "renderer/pictures/pixel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "renderer/image/magma.h"
#include "renderer/image/pixel_counts.h"
#include "renderer/pictures/picture_file.h"
#include "tests/unit/schema_walk.h"

namespace sheer::pixel_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Half of red over a quarter of green over the background.
PixelStack known_stack() {
    PixelStack stack;
    stack.background = {0.2, 0.4, 0.8};
    stack.fragments.resize(2);
    stack.fragments[0] = {.depth = 0.25, .color = {1, 0, 0}, .alpha = 0.5, .primitive = 7};
    stack.fragments[1] = {.depth = 0.5, .color = {0, 1, 0}, .alpha = 0.25, .primitive = 3};
    weigh(stack);
    return stack;
}

class PixelReportTest : public testing::Test {
  protected:
    static constexpr int x = 2, y = 1, width_px = 3, height_px = 2;

    json put(const std::string& name, const std::string& bytes) {
        m_pictures[name] = bytes;
        return {{"sha256", name}};
    }

    json color_image(const std::string& name, const std::array<float, 3>& color, bool linear) {
        Image image(width_px, height_px);
        for (std::size_t i = 0; i < 3; ++i) image.pixel(x, y)[i] = color[i];
        return put(name, linear ? encode_exr(image) : encode_png(quantize(image)));
    }

    json count_image(const std::string& name, std::uint32_t count, std::uint32_t full_scale) {
        PixelCounts counts{width_px, height_px, std::vector<std::uint32_t>(6, 0)};
        counts.counts[y * width_px + x] = count;
        json image = put(name, encode_png(count_picture(counts, full_scale)));
        image["full_scale"] = full_scale;
        return image;
    }

    static json result(const std::string& id, const json& parameters, const json& images) {
        return {{"method", id},
                {"label", id},
                {"status", "ok"},
                {"reason", nullptr},
                {"images", images},
                {"parameters", parameters},
                {"fragments", json::object()}};
    }

    json report_of(const json& results, const PixelStack& stack = known_stack()) {
        const json run = {
            {"point", json::object()},
            {"reference",
             {{"method", "exact"}, {"images", {{"linear", color_image("exact", {0.575f, 0.275f, 0.3f}, true)}}}}},
            {"results", results}};
        return to_document(
            pixel_report(stack, x, y, from_document<report::Run>(run),
                         [this](const report::Picture& picture) { return m_pictures.at(picture.sha256); }));
    }

    static std::string pixel_table(const json& pixel) { return sheer::pixel_table(from_document<pixel::Pixel>(pixel)); }

    std::map<std::string, std::string> m_pictures;
};

TEST_F(PixelReportTest, TheStackIsWeightedAndSummed) {
    const json pixel = report_of(json::array());
    EXPECT_EQ(pixel["x"], x);
    EXPECT_EQ(pixel["y"], y);
    EXPECT_EQ(pixel["opaque"], nullptr);
    ASSERT_EQ(pixel["fragments"].size(), 2u);
    EXPECT_EQ(pixel["fragments"][0]["primitive"], 7);
    EXPECT_DOUBLE_EQ(pixel["fragments"][0]["weight"], 0.5);
    EXPECT_DOUBLE_EQ(pixel["fragments"][1]["transmittance_before"], 0.5);
    EXPECT_DOUBLE_EQ(pixel["fragments"][1]["weight"], 0.125);
    EXPECT_DOUBLE_EQ(pixel["transmittance"], 0.375);
    // 0.5 + 0.375 * 0.2, 0.125 + 0.375 * 0.4, 0.375 * 0.8
    const double sum[] = {0.575, 0.275, 0.3};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_DOUBLE_EQ(pixel["sum"][i], sum[i]);
        EXPECT_NEAR(pixel["reference"]["difference"][i], 0, 1e-7);
    }
}

TEST_F(PixelReportTest, ValuesComeFromTheFinestPicture) {
    const json eight_bit = {{"color", color_image("a", {0.5f, 0.25f, 0.3f}, false)}};
    const json floats = {{"color", color_image("b", {0, 0, 0}, false)},
                         {"linear", color_image("c", {0.5f, 2.5f, -1}, true)}};
    const json pixel = report_of({result("b2f", json::object(), eight_bit), result("f2b", json::object(), floats)});
    EXPECT_DOUBLE_EQ(pixel["methods"][0]["value"][0], 128 / 255.0);
    EXPECT_DOUBLE_EQ(pixel["methods"][0]["difference"][0], 0.575 - 128 / 255.0);
    EXPECT_EQ(pixel["methods"][1]["value"], json({0.5, 2.5, -1.0}));
    EXPECT_EQ(pixel["methods"][1]["shaded"], nullptr);
    EXPECT_EQ(pixel["methods"][1]["shaded_reason"], "the report has no picture of it");
}

/// Every count up to 255 can be read back from its color.
TEST_F(PixelReportTest, CountsAreReadBackExactly) {
    EXPECT_EQ(std::set(magma().begin(), magma().end()).size(), 256u);
    for (const std::uint32_t full_scale : {1u, 2u, 7u, 255u}) {
        for (std::uint32_t count = 0; count <= full_scale; ++count) {
            json images = {{"color", color_image("color", {0, 0, 0}, false)}};
            images["shaded"] = count_image("shaded", count, full_scale);
            images["saturation"] = count_image("saturation", count, full_scale);
            const json method = report_of(json::array({result("f2bd", {{"threshold", 0.1}}, images)}))["methods"][0];
            ASSERT_EQ(method["shaded"], count) << "of " << full_scale;
            // A pixel that never saturates needs all its fragments, which are two.
            ASSERT_EQ(method["needed"], count == 0 ? 2 : count);
            ASSERT_EQ(method["saturated_at"], count == 0 ? json() : json(count));
        }
    }
}

TEST_F(PixelReportTest, CountsThatCannotBeDistinguishedAreNotGuessed) {
    json images = {{"color", color_image("color", {0, 0, 0}, false)}};
    images["shaded"] = count_image("shaded", 17, 256);
    images["saturation"] = count_image("saturation", 17, 256);
    const json method = report_of(json::array({result("f2bd", {{"threshold", 0.1}}, images)}))["methods"][0];
    for (const std::string key : {"shaded", "needed", "saturated_at"}) {
        EXPECT_EQ(method[key], nullptr);
        EXPECT_THAT(method[key + "_reason"].get<std::string>(), HasSubstr("0 to 256"));
    }
}

/// If a report has fewer colors than counts, it also has a picture of the counts themselves.
TEST_F(PixelReportTest, GreatCountsHaveASeparatePicture) {
    json images = {{"color", color_image("color", {0, 0, 0}, false)}};
    PixelCounts counts{width_px, height_px, std::vector<std::uint32_t>(6, 0)};
    for (const std::uint32_t count : {0u, 255u, 1001u, 1002u, 70'001u}) {
        counts.counts[y * width_px + x] = count;
        for (const std::string key : {"shaded", "saturation"}) {
            images[key] = count_image(key, count, 70'001);
            images[key + "_counts"] = put(key + "_counts", encode_exr(counts));
        }
        const json method = report_of(json::array({result("f2bd", {{"threshold", 0.1}}, images)}))["methods"][0];
        EXPECT_EQ(method["shaded"], count);
        EXPECT_EQ(method["needed"], count == 0 ? 2 : count);
        EXPECT_EQ(method["saturated_at"], count == 0 ? json() : json(count));
    }
}

/// A fact of each kind, as JSON and as a person reads it.
TEST_F(PixelReportTest, MethodsExplainTheirValues) {
    PixelStack stack = known_stack();
    const json sample = {{"fragment", nullptr}, {"color", {0.25, 0.5, 0.75}}};
    stack.methods = {{.facts = {number_fact("alpha_sum", 0.75, "The sum."),
                                color_fact("color", {0.5f, 0, 1}, "That."),
                                fragment_fact("shown", 2, "Seen."),
                                fragment_fact("marked", std::nullopt, "Marked."),
                                fragments_fact("blended", {1, 2, 3, 7, 9, 10, 6, 5, 4, 3}, "In order."),
                                fragments_fact("cut", {}, "Not drawn."),
                                {"samples", "samples", json::array({sample}), "Of each."}},
                      .value = Rgb{0.5, 0.25, 0.3}}};
    const json images = {{"color", color_image("a", {0.5f, 0.25f, 0.3f}, false)}};
    const json pixel = report_of(json::array({result("b2f", json::object(), images)}), stack);
    const json& method = pixel["methods"][0];
    ASSERT_EQ(method["explanation"].size(), 7u);
    EXPECT_EQ(method["explanation"][2],
              json({{"name", "shown"}, {"kind", "fragment"}, {"value", 2}, {"text", "Seen."}}));
    EXPECT_EQ(method["explanation"][3]["value"], json());
    EXPECT_EQ(method["explained_value"], json({0.5, 0.25, 0.3}));
    EXPECT_FALSE(method.contains("explanation_reason"));
    const std::string table = pixel_table(pixel);
    for (const char* line :
         {"alpha_sum        0.75\n", "color            0.500000 0.000000 1.000000\n", "shown            2\n",
          "marked           none\n", "blended          1-3, 7, 9, 10, 6-3\n", "cut              none\n",
          "samples          opaque: 0.250000 0.500000 0.750000\n", "The sum.\n"})
        EXPECT_THAT(table, HasSubstr(line));
}

TEST_F(PixelReportTest, AnExplanationOfAnotherPictureSaysSo) {
    PixelStack stack = known_stack();
    stack.methods = {{.facts = {number_fact("alpha_sum", 0.75, "The sum.")}, .value = Rgb{0.5, 0.25, 0.31}},
                     {.reason = "no float targets"}};
    const json images = {{"color", color_image("a", {0.5f, 0.25f, 0.3f}, false)}};
    const json one = result("b2f", json::object(), images);
    const json pixel = report_of(json::array({one, one, one}), stack);
    EXPECT_EQ(pixel["methods"][0]["explanation"].size(), 1u);
    EXPECT_THAT(pixel["methods"][0]["explanation_reason"].get<std::string>(),
                HasSubstr("differs from the report's picture"));
    EXPECT_EQ(pixel["methods"][1]["explanation"], json());
    EXPECT_EQ(pixel["methods"][1]["explanation_reason"], "no float targets");
    EXPECT_EQ(pixel["methods"][2]["explanation"], json()) << "only two were drawn again";
    EXPECT_THAT(pixel_table(pixel), HasSubstr("Note: no float targets"));
}

TEST_F(PixelReportTest, AMethodThatDidNotRunSaysWhy) {
    json one = result("meshkin", json::object(), json::object());
    one["status"] = "unsupported";
    one["reason"] = "no float targets";
    const json method = report_of(json::array({one}))["methods"][0];
    EXPECT_EQ(method["value"], nullptr);
    EXPECT_EQ(method["reason"], "no float targets");
    EXPECT_THAT(pixel_table(report_of(json::array({one}))), HasSubstr("unsupported: no float targets"));
}

TEST_F(PixelReportTest, MatchesItsDescription) {
    PixelStack stack = known_stack();
    stack.opaque = OpaqueFragment{.depth = 0.75, .color = {1, 1, 1}};
    stack.methods = {{.facts = {number_fact("alpha_sum", 0.75, "The sum.")}, .value = Rgb{0.5, 0.25, 0.31}}};
    json images = {{"color", color_image("color", {0, 0, 0}, false)}};
    images["shaded"] = images["saturation"] = count_image("shaded", 17, 256);
    const json pixel = report_of(json::array({result("f2bd", {{"threshold", 0.1}}, images)}), stack);
    SchemaWalk walk = SchemaWalk::of<pixel::Pixel>();
    walk.check(pixel);
    EXPECT_THAT(walk.missing(), testing::IsEmpty());
    EXPECT_EQ(to_document(from_document<pixel::Pixel>(pixel)), pixel);
}

TEST_F(PixelReportTest, AChannelThatIsNotFiniteIsNull) {
    const float infinite = std::numeric_limits<float>::infinity();
    const json images = {{"linear", color_image("a", {infinite, 0.25f, 0.5f}, true)}};
    const json pixel = report_of(json::array({result("b2f", json::object(), images)}));
    EXPECT_EQ(pixel["methods"][0]["value"], json({nullptr, 0.25, 0.5}));
    EXPECT_EQ(to_document(from_document<pixel::Pixel>(pixel)), pixel);
}

TEST_F(PixelReportTest, AMethodWithoutAPictureIsAnError) {
    EXPECT_THROW(report_of(json::array({result("b2f", json::object(), json::object())})), std::runtime_error);
}

TEST_F(PixelReportTest, DamagedPicturesAreErrors) {
    EXPECT_THROW(read_pixel("neither", 0, 0), std::runtime_error);
    const std::string png = encode_png(Image8(3, 2));
    EXPECT_THROW(read_pixel(png, 3, 0), std::runtime_error);
    EXPECT_THROW(read_pixel(png.substr(0, 20), 0, 0), std::runtime_error);
}

}  // namespace
}  // namespace sheer::pixel_test
