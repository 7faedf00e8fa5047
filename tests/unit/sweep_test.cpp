#include "renderer/spec/sweep.h"

#include <gmock/gmock.h>

#include "renderer/spec/spec.h"

namespace sheer::sweep_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

json document(const json& sweep) {
    return {{"scene", {{"type", "quads"}, {"count", 8}}},
            {"methods", {"b2f", {{"id", "f2bd"}, {"threshold", 0.02}}}},
            {"sweep", sweep}};
}

json axis(const std::string& pointer, const json& values) {
    return {{"pointer", pointer}, {"values", values}};
}

std::vector<FieldError> errors_of(const json& spec) {
    try {
        parse_spec(spec);
    } catch (const SpecError& error) {
        return error.errors();
    }
    return {};
}

TEST(Sweep, WithoutAxesIsOnePoint) {
    EXPECT_THAT(parse_spec(document(json::array())).points, ElementsAre(json::object()));
}

TEST(Sweep, IsTheProductOfItsAxesTheLastFastest) {
    const Spec spec =
        parse_spec(document(json::array({axis("/scene/count", {1, 16}), axis("/methods/1/threshold", {0.0, 0.5})})));
    EXPECT_THAT(spec.points, ElementsAre(json{{"/scene/count", 1}, {"/methods/1/threshold", 0.0}},
                                         json{{"/scene/count", 1}, {"/methods/1/threshold", 0.5}},
                                         json{{"/scene/count", 16}, {"/methods/1/threshold", 0.0}},
                                         json{{"/scene/count", 16}, {"/methods/1/threshold", 0.5}}));
    const Spec last = spec_at(spec, spec.points.back());
    EXPECT_EQ(last.scene["count"], 16);
    EXPECT_EQ(last.methods[1].parameters["threshold"], 0.5);
    EXPECT_THAT(last.points, ElementsAre(json::object()));
}

TEST(Sweep, ReachesDefaultsAndSetsSeveralFieldsAtOnce) {
    const json points = json::array({{{"/scene/shading", "constant"}, {"/image/width", 64}},
                                     {{"/scene/shading", "1-texture"}, {"/scene/texture/size", 64}}});
    const Spec spec = parse_spec(document(json::array({{{"points", points}}})));
    ASSERT_EQ(spec.points.size(), 2u);
    EXPECT_EQ(spec_at(spec, spec.points[0]).image.width_px, 64);
    EXPECT_EQ(spec_at(spec, spec.points[1]).scene["texture"]["size"], 64);
    EXPECT_EQ(describe_point(spec.points[1]), "shading 1-texture, size 64");
}

TEST(Sweep, RefusesOtherFieldsThanParameters) {
    for (const std::string pointer : {"/scene/type", "/scene/no_such", "/timing/rounds", "/methods/1/id", "/title",
                                      "/methods/7/threshold", "scene/count", ""}) {
        SCOPED_TRACE(pointer);
        const auto errors = errors_of(document(json::array({axis(pointer, {1})})));
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_EQ(errors[0].pointer, "/sweep/0/pointer");
    }
}

TEST(Sweep, RefusesAWrongValueAtItsPointer) {
    const auto errors = errors_of(document(json::array({axis("/image/width", {64}), axis("/scene/count", {1, 0})})));
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].pointer, "/sweep/1");
    EXPECT_THAT(errors[0].detail, HasSubstr("\"/scene/count\":0"));
    EXPECT_THAT(errors[0].detail, HasSubstr("must be"));
}

TEST(Sweep, RefusesWrongShapes) {
    const std::vector<std::pair<json, std::string>> cases = {
        {json::object(), "/sweep"},
        {json::array({1}), "/sweep/0"},
        {json::array({{{"pointer", "/scene/count"}}}), "/sweep/0"},
        {json::array({axis("/scene/count", json::array())}), "/sweep/0/values"},
        {json::array({{{"points", json::array()}}}), "/sweep/0/points"},
        {json::array({{{"points", json::array({json::object()})}}}), "/sweep/0/points/0"},
        {json::array({axis("/scene/count", {1}), axis("/scene/count", {2})}), "/sweep/1/pointer"},
        {json::array({axis("/scene/seed", json(std::vector<int>(257, 1)))}), "/sweep"},
    };
    for (const auto& [sweep, pointer] : cases) {
        SCOPED_TRACE(sweep.dump());
        const auto errors = errors_of(document(sweep));
        ASSERT_FALSE(errors.empty());
        EXPECT_EQ(errors[0].pointer, pointer);
    }
}

TEST(Sweep, RefusesToSetAFieldTwice) {
    const json layers = {{"scene", {{"type", "layers"}, {"layers", {{{"depth", 0.5}}, {{"depth", 0.25}}}}}},
                         {"methods", {"b2f", {{"id", "f2bd"}}}}};
    const auto point = [](const json& fields) { return json{{"points", json::array({fields})}}; };
    const std::vector<std::pair<json, std::string>> cases = {
        {json::array({axis("/scene/layers/0/alpha", {0.5}), point({{"/scene/layers/0/alpha", 0.1}})}),
         "/sweep/1/points/0"},
        {json::array({point({{"/scene/layers/0/alpha", 0.1}}), axis("/scene/layers/0/alpha", {0.5})}),
         "/sweep/1/pointer"},
        {json::array({point({{"/image/width", 8}}), point({{"/image/height", 8}, {"/image/width", 9}})}),
         "/sweep/1/points/0"},
        // One of the two contains the other one.
        {json::array({axis("/scene/layers", {json::array({{{"depth", 0.5}}})}), point({{"/scene/layers/0/alpha", 1}})}),
         "/sweep/1/points/0"},
        {json::array({axis("/methods/1/threshold", {0.1}), axis("/methods/1", {"b2f"})}), "/sweep/1/pointer"},
        {json::array({point({{"/scene/layers/1", {{"depth", 0.1}}}, {"/scene/layers/1/color/0", 0.2}})}),
         "/sweep/0/points/0"},
    };
    for (const auto& [sweep, pointer] : cases) {
        SCOPED_TRACE(sweep.dump());
        json spec = layers;
        spec["sweep"] = sweep;
        const auto errors = errors_of(spec);
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_EQ(errors[0].pointer, pointer);
        EXPECT_THAT(errors[0].detail, testing::AnyOf(HasSubstr("is swept already"), HasSubstr("overlaps")));
    }
    // Two fields, although the name of one is the beginning of the other's.
    json neighbours = layers;
    neighbours["scene"]["layers"] = json::array();
    for (int i = 0; i < 12; ++i) neighbours["scene"]["layers"].push_back({{"depth", 0.5}});
    neighbours["sweep"] = json::array({axis("/scene/layers/1/alpha", {0.5}), point({{"/scene/layers/11/alpha", 0.1}})});
    EXPECT_TRUE(errors_of(neighbours).empty());
}

TEST(Sweep, OfOneFieldLeavesALargeSceneAlone) {
    json spec = {{"scene", {{"type", "layers"}, {"layers", json::array()}}}, {"methods", {"b2f"}}};
    for (int i = 0; i < 4096; ++i) spec["scene"]["layers"].push_back({{"depth", 0.5}});
    json widths = json::array();
    for (int i = 1; i <= 256; ++i) widths.push_back(i);
    spec["sweep"] = json::array({axis("/image/width", widths)});
    const Spec read = parse_spec(spec);
    EXPECT_EQ(read.points.size(), 256u);
    EXPECT_EQ(spec_at(read, read.points[7]).scene["layers"].size(), 4096u);
    // A wrong point is found nevertheless.
    spec["sweep"][0]["values"][200] = 0;
    EXPECT_THAT(errors_of(spec).at(0).detail, HasSubstr("/image/width"));
}

TEST(Sweep, IsBoundedInWhatItRepeats) {
    json spec = {{"scene", {{"type", "layers"}, {"layers", json::array()}}}, {"methods", {"b2f"}}};
    for (int i = 0; i < 4096; ++i) spec["scene"]["layers"].push_back({{"depth", 0.5}});
    json alphas = json::array();
    for (int i = 1; i <= 256; ++i) alphas.push_back(i / 256.0);
    spec["sweep"] = json::array({axis("/scene/layers/9/alpha", alphas)});
    const auto errors = errors_of(spec);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].pointer, "/sweep");
    // One large value with many points.
    json large = document(json::array({axis("/scene/shading", json::array({std::string(2'000'000, 'x')})),
                                       axis("/image/width", json(std::vector<int>(256, 8)))}));
    ASSERT_EQ(errors_of(large).size(), 1u);
    EXPECT_EQ(errors_of(large)[0].pointer, "/sweep");
    EXPECT_EQ(json_weight(json::parse(R"({"a": [1, 2], "b": "text"})")), 5u);
    EXPECT_EQ(json_weight(std::string(64, 'x')), 3u);
}

TEST(Sweep, ListsAHundredErrorsAndCountsTheRest) {
    json values = json::array();
    for (int i = 0; i < 256; ++i) values.push_back(-i);
    EXPECT_EQ(errors_of(document(json::array({axis("/image/width", values)}))).size(), max_told_errors);
}

TEST(Sweep, ChecksApplyAtThePointsTheyName) {
    json spec = document(json::array({axis("/scene/count", {1, 16})}));
    spec["checks"] =
        json::array({{{"metric", "rmse"}, {"method", "f2bd"}, {"max", 0.1}, {"at", {{"/scene/count", 16}}}}});
    EXPECT_EQ(parse_spec(spec).checks[0].at, json({{"/scene/count", 16}}));
    spec["checks"][0]["at"] = {{"/scene/count", 17}};
    const auto errors = errors_of(spec);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].pointer, "/checks/0/at");
}

TEST(Sweep, NormalisedSpecMeansTheSame) {
    const Spec spec = parse_spec(document(json::array({axis("/scene/count", {1, 16})})));
    EXPECT_EQ(parse_spec(spec.normalised).normalised, spec.normalised);
}

}  // namespace

}  // namespace sheer::sweep_test
