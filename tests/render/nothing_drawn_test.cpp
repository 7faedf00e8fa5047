// A comparison in which nothing transparent is drawn says so, with its cause.
#include <gmock/gmock.h>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::nothing_drawn_test {

namespace {

using nlohmann::json;

json layer(const json& rect, double depth, double alpha, bool opaque = false) {
    return {{"rect", rect}, {"depth", depth}, {"alpha", alpha}, {"color", {1, 0, 0}}, {"opaque", opaque}};
}

sheer::Run compare_scene(const json& scene) {
    const Spec spec = parse_spec({{"scene", scene},
                                  {"methods", {"b2f"}},
                                  {"image", {{"width", 16}, {"height", 16}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { runs.push_back(run); });
    return runs.at(0);
}

std::string why(const json& layers) {
    const sheer::Run run = compare_scene({{"type", "layers"}, {"layers", layers}});
    EXPECT_EQ(run.results[0].status, report::ResultStatus::ok) << run.results[0].reason;
    if (run.nothing_drawn.empty()) {
        EXPECT_TRUE(run.notes.empty());
        return "";
    }
    EXPECT_EQ(run.notes, (std::vector<Note>{{"nothing-transparent", run.nothing_drawn, "/scene"}}));
    return run.nothing_drawn;
}

const json whole = {0, 0, 1, 1};

TEST(NothingDrawn, HasACause) {
    EXPECT_EQ(why(json::array({layer(whole, 0.5, 1, true)})),
              "Nothing transparent was drawn: the scene has no layers other than opaque ones.");
    EXPECT_EQ(why(json::array({layer({2, 2, 3, 3}, 0.5, 0.5), layer({-1, 0, -0.5, 1}, 0.5, 0.5)})),
              "Nothing transparent was drawn: all of it is outside the camera's view.");
    EXPECT_EQ(why(json::array({layer(whole, 0.25, 1, true), layer(whole, 0.5, 0.5)})),
              "Nothing transparent was drawn: opaque geometry hides all of it.");
    EXPECT_EQ(why(json::array({layer(whole, 0.5, 0), layer(whole, 0.25, 0)})),
              "Nothing transparent was drawn: all of it has an alpha of 0.");
    // A hundredth of a pixel's width, between two centres.
    EXPECT_EQ(why(json::array({layer({0.5, 0.5, 0.5006, 0.5006}, 0.5, 0.5)})),
              "Nothing transparent was drawn: it covers no pixel's centre, or only its back faces are in view.");
}

TEST(NothingDrawn, IsNotSaidWhereThereIsSomething) {
    EXPECT_EQ(why(json::array({layer(whole, 0.5, 0.5)})), "");
    EXPECT_EQ(
        why(json::array({layer(whole, 0.25, 1, true), layer(whole, 0.5, 0.5), layer({0, 0, 0.1, 0.1}, 0.1, 0.5)})), "");
    EXPECT_EQ(why(json::array({layer(whole, 0.5, 0), layer({0, 0, 0.1, 0.1}, 0.25, 0.001)})), "");
    EXPECT_EQ(why(json::array({layer(whole, 0.5, 1)})), "") << "an alpha of 1 is something";
}

TEST(NothingDrawn, IsToldOfShadingOfOnesOwn) {
    const json scene = {{"type", "quads"}, {"count", 3}, {"shading", {{"glsl", "return vec4(tint.rgb, 0.0);"}}}};
    EXPECT_THAT(compare_scene(scene).nothing_drawn, testing::HasSubstr("an alpha of 0"));
}

}  // namespace

}  // namespace sheer::test::nothing_drawn_test
