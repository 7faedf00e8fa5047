// User-defined shadings.
#include <gmock/gmock.h>

#include <cmath>

#include "renderer/compare/compare.h"
#include "renderer/counting/loop_check.h"
#include "renderer/glsl/own_shading.h"
#include "tests/render/render_test.h"

namespace sheer::test::glsl_shading_test {

namespace {

using nlohmann::json;

constexpr int size_px = 32;

json own(const std::string& body) {
    return {{"glsl", body}};
}

/// Two translucent layers and an opaque one between them.
json layers(const json& shading) {
    return {{"type", "layers"},
            {"shading", shading},
            {"texture", {{"size", 16}}},
            {"layers",
             {{{"rect", {0.5, 0.25, 1, 1}}, {"depth", 0.25}, {"color", {1, 0.5, 0.25}}, {"alpha", 0.5}},
              {{"rect", {0, 0.5, 0.75, 1}}, {"depth", 0.5}, {"color", {0, 1, 0.5}}, {"alpha", 1}, {"opaque", true}},
              {{"rect", {0.25, 0.25, 1, 0.75}}, {"depth", 0.75}, {"color", {0.5, 0, 1}}, {"alpha", 0.25}}}}};
}

/// The error that checking the scene's loops or making the method `b2f` ends with; "" for none.
std::string error_of(const std::string& body) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(layers(own(body)), {"b2f"}, size_px);
    try {
        Stage stage(*context, spec, PixelFormat::rgba8);
        check_loops(context->gl(), stage.scene(), spec.image);
        stage.picture(spec.methods[0]);
    } catch (const SpecError& error) {
        EXPECT_EQ(error.errors().size(), 1u);
        EXPECT_EQ(error.errors()[0].pointer, "/scene/shading/glsl");
        return error.errors()[0].detail;
    }
    return "";
}

TEST(GlslShading, OfTheTintAloneIsConstantForEveryMethod) {
    json methods = json::array();
    for (const MethodInfo& method : all_methods()) methods.push_back(method.id);
    const std::string body = "vec4 sum = vec4(0.0);\nfor (int i = 0; i < 4; ++i) sum += tint;\nreturn sum / 4.0;";
    for (const std::string& kind : contexts()) {
        const auto context = make_context(kind);
        const Spec constant = make_spec(layers("constant"), methods, size_px);
        const Spec mine = make_spec(layers(own(body)), methods, size_px);
        Stage expected(*context, constant, PixelFormat::rgba8), actual(*context, mine, PixelFormat::rgba8);
        for (const MethodSpec& method : constant.methods) {
            try {
                const Image image = actual.picture(method);
                EXPECT_EQ(greatest_difference(expected.picture(method), image), 0) << method.label << ' ' << kind;
            } catch (const Unsupported&) {
                // The device lacks something that this method needs.
            }
        }
    }
}

TEST(GlslShading, SeesWhereTheFragmentIs) {
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"},
                                 {"shading", own("return vec4(uv, float(v_primitive) * 0.25, v_position.z);")},
                                 {"layers",
                                  {{{"rect", {0, 0, 1, 1}}, {"depth", 0.75}, {"color", {0, 0, 0}}, {"alpha", 0}},
                                   {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {0, 0, 0}}, {"alpha", 0}}}}},
                                {"b2f"}, size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image image = stage.picture(spec.methods[0]);
    // The middle of pixel (4, 20) is at (4.5, 20.5) / 32 of each layer. Alpha is the depth: 0.75 behind, 0.5 in front.
    const double background[] = {0.2, 0.4, 0.6}, behind[] = {4.5 / 32, 20.5 / 32, 0},
                 before[] = {4.5 / 32, 20.5 / 32, 0.25};
    for (int channel = 0; channel < 3; ++channel) {
        const double first = 0.25 * background[channel] + 0.75 * behind[channel];
        EXPECT_NEAR(image.pixel(4, 20)[channel], 0.5 * first + 0.5 * before[channel], 1e-5) << channel;
    }
}

TEST(GlslShading, ReadsTheTexturesAsTheBuiltInShadingDoes) {
    const auto context = make_context("egl");
    const json quads = {{"type", "quads"}, {"count", 12}, {"texture", {{"image", "leaf"}, {"size", 64}}}};
    json built_in = quads, mine = quads;
    built_in["shading"] = "1-texture";
    mine["shading"] = own("return sample_texture(int(v_primitive), uv) * tint;");
    const Spec expected = make_spec(built_in, {"b2f"}, 64, "rgba32f"), actual = make_spec(mine, {"b2f"}, 64, "rgba32f");
    Stage expected_stage(*context, expected, PixelFormat::rgba32f),
        actual_stage(*context, actual, PixelFormat::rgba32f);
    const Image textured = expected_stage.picture(expected.methods[0]);
    EXPECT_LT(greatest_difference(textured, actual_stage.picture(actual.methods[0])), 1e-5);
    mine["shading"] = "constant";
    const Spec constant = make_spec(mine, {"b2f"}, 64, "rgba32f");
    Stage constant_stage(*context, constant, PixelFormat::rgba32f);
    EXPECT_GT(greatest_difference(textured, constant_stage.picture(constant.methods[0])), 0.1);
}

TEST(GlslShading, ColorsEveryKindOfScene) {
    const auto context = make_context("egl");
    for (const json& scene : {json{{"type", "quads"}, {"count", 40}}, json{{"type", "particles"}, {"count", 400}},
                              json{{"type", "foliage"}, {"trees", 1}, {"planes_per_tree", 40}}}) {
        json mine = scene;
        mine["shading"] = own("return vec4(0.0, 1.0, 0.0, 1.0);");
        const Spec spec = make_spec(mine, {"f2b"}, size_px);
        Stage stage(*context, spec, PixelFormat::rgba8);
        const Image image = stage.picture(spec.methods[0]);
        int green = 0;
        for (std::size_t i = 0; i < image.rgba.size(); i += 4)
            green += image.rgba[i] == 0 && image.rgba[i + 1] == 1 && image.rgba[i + 2] == 0;
        EXPECT_GT(green, 20) << scene;
    }
}

TEST(GlslShading, CompileErrorsHaveTheUsersLines) {
    EXPECT_THAT(error_of("vec4 a = tint; // {\n/*\n*/ a.rgb = color;\nreturn a;"),
                testing::AllOf(testing::HasSubstr("\nline 3: "), testing::HasSubstr("color")));
    EXPECT_THAT(error_of("for (int i = 0; i < count;\n ++i) {}\nreturn tint;"),
                testing::AllOf(testing::HasSubstr("\nline 1: "), testing::HasSubstr("count")));
    EXPECT_THAT(error_of("return\ntint"), testing::HasSubstr("\nline 2: "));
    EXPECT_THAT(error_of("tint.a = 1.0;"), testing::HasSubstr("\nline 1: "));
    EXPECT_THAT(error_of("return tint;\n\nvec3 f() { return vec3(0); }"), testing::HasSubstr("\nline 3: "));
    EXPECT_EQ(error_of("return tint;"), "");
}

TEST(GlslShading, EndlessLoopsAreNamedWithAPixel) {
    for (const std::string loop : {"for (;;) {}", "for (int i = 0; i < 5; i += 0) tint.r += 0.1;", "while (true);",
                                   "do { tint.a *= 0.5; } while (tint.a >= 0.0);",
                                   "for (int i = 0; i < 2; ++i) while (tint.a <= 1.0) { if (i == 2) break; }"})
        EXPECT_THAT(error_of(loop + " return tint;"), testing::HasSubstr("pixel (8, 8)")) << loop;
    // Only at the opaque layer's corner; the loops of what is behind or in front of it end.
    EXPECT_THAT(error_of("while (v_primitive == 1u) {} return tint;"), testing::HasSubstr("pixel (0, 16)"));
    EXPECT_THAT(error_of("while (v_primitive == 1u && uv.x > 0.5 && uv.y > 0.5) {} return tint;"),
                testing::AllOf(testing::HasSubstr("pixel (12, 24)"), testing::HasSubstr("96 pixels")));
}

TEST(GlslShading, TheLoopsOfAFragmentShareItsIterations) {
    const auto twice = [](int first, int second) {
        return "for (int i = 0; i < " + std::to_string(first) + "; ++i) tint.r *= 0.999;\nint n = 0;\nwhile (n < " +
               std::to_string(second) + ") ++n;\nreturn tint;";
    };
    EXPECT_EQ(error_of(twice(iterations_per_fragment - 1000, 1000)), "");
    EXPECT_THAT(error_of(twice(iterations_per_fragment - 1000, 1001)), testing::HasSubstr("4096 iterations"));
}

/// Runs a whole comparison; the error it ends with, or "".
std::string error_of_comparison(const json& scene, const json& methods) {
    const auto context = make_context("egl");
    const Spec spec = parse_spec({{"scene", scene},
                                  {"methods", methods},
                                  {"image", {{"width", size_px}, {"height", size_px}}},
                                  {"timing", {{"rounds", 1}, {"warmup", 1}}}});
    NoAssets assets;
    try {
        compare(
            spec, *context, assets, [](double, const std::string&) {}, [](const sheer::Run&) {});
    } catch (const SpecError& error) {
        EXPECT_EQ(error.errors().at(0).pointer, "/scene/shading/glsl");
        return error.errors().at(0).detail;
    }
    return "";
}

/// With several samples the edge of a rectangle at 8.2 pixels shades pixel 8 at its middle, where uv.x is over 1, and
/// with a cap a coarse picture shades yet other places. Only there does the loop not end.
TEST(GlslShading, LoopsAreCheckedInEveryMethod) {
    const auto scene_with = [](const std::string& condition, bool opaque) {
        return json{
            {"type", "layers"},
            {"shading", own("float x = 0.0;\nwhile (" + condition + ") x += 1e-12;\nreturn vec4(x, tint.gba);")},
            {"layers",
             {{{"rect", {0, 0, 8.2 / size_px, 1}},
               {"depth", 0.5},
               {"color", {1, 1, 1}},
               {"alpha", 1},
               {"opaque", opaque}}}}};
    };
    const json several = {"b2f", "alpha_to_coverage"};
    EXPECT_THAT(error_of_comparison(scene_with("uv.x > 1.0", false), several),
                testing::HasSubstr("when alpha_to_coverage draws it"));
    EXPECT_EQ(error_of_comparison(scene_with("uv.x > 1.0", false), {"b2f", "f2b", "exact"}), "");
    EXPECT_EQ(error_of_comparison(scene_with("uv.x > 1.5", false), several), "");
    EXPECT_THAT(error_of_comparison(scene_with("x < 1.0", false), {"b2f"}), testing::HasSubstr("4096 iterations"));
    // The middles of the coarse picture's pixels lie at whole numbers.
    const std::string coarse =
        "fract(gl_FragCoord.x) == 0.5 && gl_FragCoord.y < 8.0 && abs(fract(uv.y * 8.0) - 0.5) < 0.05";
    const json cap = {{"id", "stencil_cap"}, {"zcull", true}, {"frames", 1}};
    EXPECT_THAT(error_of_comparison(scene_with(coarse, false), json::array({cap})), testing::HasSubstr("stencil_cap"));
}

/// A guarded division gives the same as an unguarded one, for every type and sign, and the least integer by -1 is
/// itself, constant or not. The picture shows whether all of this is true.
TEST(GlslShading, DivisionsAreThoseOfTheLanguage) {
    const std::string body =
        "int least = -2147483647 - 1, minus = -1, five = 5, two = -2;\n"
        "int late = int(gl_FragCoord.x * 0.0) - 1;\n"
        "bool ok = least / minus == least && least % minus == 0 && least / late == least && five / minus == -5;\n"
        "ok = ok && five / two == -2 && five * 3 / two * 2 == -14 && (ivec2(7, least) / ivec2(2, minus)) == ivec2(3, "
        "least);\n"
        "ok = ok && 9u / uint(five) == 1u && 7u % uint(five) == 2u && float(five) / tint.a == 5.0 / tint.a;\n"
        "vec3 v = vec3(1.0, 2.0, 4.0); mat2 m = mat2(2.0, 4.0, 6.0, 8.0);\n"
        "ok = ok && v / five == v / 5.0 && v / v == vec3(1.0) && (m / 2.0)[1] == vec2(3.0, 4.0) && m / m == mat2(1.0, "
        "1.0, 1.0, 1.0);\n"
        "ok = ok && double(five) / double(2.0) == double(2.5) && 1 / tint.a == 1.0 / tint.a;\n"
        "least /= minus; five /= two; v.y /= 4.0; v.xz /= v.z;\n"
        "ok = ok && least == -2147483647 - 1 && five == -2 && v == vec3(0.25, 0.5, 1.0);\n"
        "int a[4]; a[3] = 7; a[1 + 2] /= 2; a[3] %= minus; ok = ok && a[3] == 0;\n"
        "return vec4(ok ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), 1.0);";
    EXPECT_EQ(error_of(body), "");
    const auto context = make_context("egl");
    const Spec spec = make_spec(layers(own(body)), {"b2f"}, size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    const Image picture = stage.picture(spec.methods[0]);
    const float* pixel = picture.pixel(20, 10);
    EXPECT_EQ(pixel[0], 0);
    EXPECT_EQ(pixel[1], 1);
}

/// The largest allowed arrays are drawn.
TEST(GlslShading, ArraysOfTheLimitAreDrawn) {
    if (!make_context("egl")->device().software) GTEST_SKIP() << "a GPU may have fewer registers, and says so";
    EXPECT_EQ(error_of("float a[4096]; for (int i = 0; i < 16; ++i) a[i * 255] = tint.r;\n"
                       "return vec4(a[int(uv.x * 15.0) * 255], tint.gba);"),
              "");
}

/// Bounded by the counter even where each iteration runs further loops: the driver's own limit is never met.
TEST(GlslShading, EndlessLoopsEndInAMethodToo) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(
        layers(own("for (;;) { for (;;) { while (true) {} } } return vec4(0.0, 1.0, 0.0, 1.0);")), {"f2b"}, size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    EXPECT_EQ(stage.picture(spec.methods[0]).pixel(20, 10)[1], 1);
}

/// No report fails because of what a user's function returns, and all methods get the same numbers.
TEST(GlslShading, WhatIsNoNumberAndWhatIsTooLargeGivesAReport) {
    for (const std::string value : {"0.0 / (tint.a - tint.a)", "1e30 * 1e30 * tint.a", "-1e30", "sqrt(-tint.a)"}) {
        const auto context = make_context("egl");
        const Spec spec =
            make_spec(layers(own("return vec4(" + value + ");")), {"b2f", "f2b", "meshkin"}, size_px, "rgba32f");
        NoAssets assets;
        int ok = 0;
        const auto check = [&](const sheer::Run& run) {
            for (const MethodResult& result : run.results) {
                ok += result.status == report::ResultStatus::ok ? 1 : 0;
                for (const float number : result.image.rgba)
                    ASSERT_TRUE(std::isfinite(number)) << value << ' ' << result.method.id;
            }
        };
        compare(
            spec, *context, assets, [](double, const std::string&) {}, check);
        EXPECT_EQ(ok, 3) << value;
    }
}

}  // namespace

}  // namespace sheer::test::glsl_shading_test
