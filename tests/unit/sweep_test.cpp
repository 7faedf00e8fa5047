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

TEST(Sweep, RefusesWhatIsNoParameter) {
    for (const std::string pointer : {"/scene/type", "/scene/no_such", "/timing/rounds", "/methods/1/id", "/title",
                                      "/methods/7/threshold", "scene/count", ""}) {
        SCOPED_TRACE(pointer);
        const auto errors = errors_of(document(json::array({axis(pointer, {1})})));
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_EQ(errors[0].pointer, "/sweep/0/pointer");
    }
}

TEST(Sweep, RefusesAWrongValueWhereItStands) {
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

TEST(Sweep, ChecksHoldAtThePointsTheyName) {
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
