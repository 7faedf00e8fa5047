#include "renderer/spec/spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/methods/shared/method.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/shaders.h"

namespace sheer::spec_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

json smallest() {
    return {{"scene", {{"type", "quads"}}}, {"methods", {"b2f", "f2bd"}}};
}

/// `document` with the value at `pointer` replaced.
json with(const std::string& pointer, const json& value, json document = smallest()) {
    document[json::json_pointer(pointer)] = value;
    return document;
}

std::vector<std::string> wrong_fields(const json& document) {
    std::vector<std::string> pointers;
    try {
        parse_spec(document);
    } catch (const SpecError& error) {
        for (const FieldError& field : error.errors()) pointers.push_back(field.pointer);
    }
    return pointers;
}

TEST(Spec, FillsInDefaults) {
    const Spec spec = parse_spec(smallest());
    EXPECT_EQ(spec.image.width_px, 512);
    EXPECT_EQ(spec.image.height_px, 512);
    EXPECT_EQ(spec.image.format, PixelFormat::rgba8);
    EXPECT_EQ(spec.scene["count"], 1024);
    EXPECT_EQ(spec.scene["shading"], "4x4-textures");
    EXPECT_EQ(spec.scene["texture"]["size"], 1024);
    EXPECT_EQ(spec.reference.id, "exact");
    EXPECT_EQ(spec.reference.parameters["form"], "auto");
    EXPECT_EQ(spec.baseline, "b2f");
    EXPECT_EQ(spec.timing.rounds, 10);
    EXPECT_EQ(spec.methods[1].parameters["threshold"], 0.01);
    EXPECT_EQ(spec.methods[1].parameters["sync"], "barrier");
}

TEST(Spec, NormalisedFormGivesTheSameSpec) {
    const Spec first = parse_spec(with("/methods/1", {{"id", "F2BD"}, {"threshold", 0.02}, {"label", "half"}}));
    const Spec second = parse_spec(first.normalised);
    EXPECT_EQ(first.normalised, second.normalised);
    EXPECT_EQ(first.canonical_text(), second.canonical_text());
}

TEST(Spec, IdsIgnoreCase) {
    const Spec spec = parse_spec({{"scene", {{"type", "Quads"}}}, {"methods", {"B2F", "f2Bd"}}, {"baseline", "F2BD"}});
    EXPECT_EQ(spec.scene_type, "quads");
    EXPECT_EQ(spec.methods[0].id, "b2f");
    EXPECT_EQ(spec.baseline, "f2bd");
}

TEST(Spec, LabelsAreNumberedIfNecessary) {
    const Spec spec = parse_spec(with("/methods", {"f2bd", {{"id", "f2bd"}, {"label", "f2bd 2"}}, "f2bd", "b2f"}));
    std::vector<std::string> labels;
    for (const MethodSpec& method : spec.methods) labels.push_back(method.label);
    EXPECT_THAT(labels, ElementsAre("f2bd", "f2bd 2", "f2bd 3", "b2f"));
}

TEST(Spec, EveryWrongFieldIsNamedAtOnce) {
    const json document = {{"tittle", "x"},
                           {"image", {{"width", 0}, {"height", 100000}, {"format", "rgb"}}},
                           {"scene", {{"type", "quads"}, {"count", 1000000000}, {"texture", {{"size", "big"}}}}},
                           {"methods", {"b2f", "nope", {{"id", "f2bd"}, {"treshold", 1}}}},
                           {"timing", {{"rounds", 1.5}}}};
    EXPECT_THAT(wrong_fields(document),
                UnorderedElementsAre("/tittle", "/image/width", "/image/height", "/image/format", "/scene/count",
                                     "/scene/texture/size", "/methods/1", "/methods/2/treshold", "/timing/rounds"));
}

struct BadSpec {
    std::string name;
    json document;
    std::string pointer;
};

void PrintTo(const BadSpec& spec, std::ostream* out) {
    *out << spec.document;
}

class BadSpecs : public testing::TestWithParam<BadSpec> {};

TEST_P(BadSpecs, NameTheField) {
    EXPECT_THAT(wrong_fields(GetParam().document), ElementsAre(GetParam().pointer));
}

const std::vector<BadSpec>& bad_specs() {
    static const json layer = {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {1, 1, 1}}, {"alpha", 1}};
    static const json layers = {{"scene", {{"type", "layers"}, {"layers", json::array({layer})}}},
                                {"methods", {"b2f"}}};
    static const std::vector<BadSpec> all = {
        {"not_an_object", json::array(), ""},
        {"no_scene", {{"methods", {"b2f"}}}, "/scene"},
        {"scene_a_text", with("/scene", "quads"), "/scene"},
        {"no_scene_type", with("/scene", json::object()), "/scene/type"},
        {"unknown_scene", with("/scene/type", "teapot"), "/scene/type"},
        {"count_zero", with("/scene/count", 0), "/scene/count"},
        {"count_huge", with("/scene/count", 1000000000), "/scene/count"},
        {"count_a_text", with("/scene/count", "12"), "/scene/count"},
        {"count_null", with("/scene/count", nullptr), "/scene/count"},
        {"size_zero", with("/image", {{"width", 0}}), "/image/width"},
        {"size_huge", with("/image", {{"height", 100000}}), "/image/height"},
        {"background_short", with("/image", {{"background", {0, 0}}}), "/image/background"},
        {"background_over_1", with("/image", {{"background", {0, 2, 0}}}), "/image/background/1"},
        {"no_methods", {{"scene", {{"type", "quads"}}}}, "/methods"},
        {"empty_methods", with("/methods", json::array()), "/methods"},
        {"unknown_method", with("/methods/0", "b3f"), "/methods/0"},
        {"method_a_number", with("/methods/0", 3), "/methods/0"},
        {"method_without_id", with("/methods/0", {{"label", "x"}}), "/methods/0/id"},
        {"threshold_over_1", with("/methods/1", {{"id", "f2bd"}, {"threshold", 1.5}}), "/methods/1/threshold"},
        {"f2bx_threshold_0", with("/methods/1", {{"id", "f2bx"}, {"threshold", 0}}), "/methods/1/threshold"},
        {"bad_choice", with("/methods/1", {{"id", "f2bd"}, {"sync", "maybe"}}), "/methods/1/sync"},
        {"two_of_a_label", with("/methods", {{{"id", "b2f"}, {"label", "x"}}, {{"id", "f2b"}, {"label", "x"}}}),
         "/methods/1/label"},
        {"unknown_reference", with("/reference", "truth"), "/reference"},
        {"unknown_baseline", with("/baseline", "f2b"), "/baseline"},
        {"unknown_field", with("/sweeep", 1), "/sweeep"},
        {"escaped_field", with("/tags", {{"a/b~c", 1}}), "/tags/a~1b~0c"},
        {"check_unknown_metric", with("/checks", {{{"metric", "beauty"}, {"method", "b2f"}, {"min", 1}}}),
         "/checks/0/metric"},
        {"check_without_limit", with("/checks", {{{"metric", "rmse"}, {"method", "b2f"}}}), "/checks/0"},
        {"check_unknown_method", with("/checks", {{{"metric", "rmse"}, {"method", "x"}, {"max", 1}}}),
         "/checks/0/method"},
        {"no_layers", with("/scene/layers", json::array(), layers), "/scene/layers"},
        {"layer_depth_0", with("/scene/layers/0/depth", 0, layers), "/scene/layers/0/depth"},
        {"layer_alpha_2", with("/scene/layers/0/alpha", 2, layers), "/scene/layers/0/alpha"},
        {"layer_unknown", with("/scene/layers/0/colour", 2, layers), "/scene/layers/0/colour"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, BadSpecs, testing::ValuesIn(bad_specs()),
                         [](const testing::TestParamInfo<BadSpec>& spec) { return spec.param.name; });

TEST(Spec, AMethodMayHaveALookOfItsOwn) {
    json document = with("/scene/texture", {{"image", "leaf"}, {"size", 64}});
    document["methods"] = {"f2bd",
                           {{"id", "f2bd"}, {"label", "new"}, {"shading", {{"glsl", "return tint;"}}}},
                           {{"id", "f2bd"}, {"label", "smoke"}, {"texture", {{"image", "smoke"}}}}};
    const Spec spec = parse_spec(document);
    EXPECT_EQ(spec.methods[0].look, json::object());
    EXPECT_EQ(spec.methods[1].look, json({{"shading", {{"glsl", "return tint;"}}}}));
    EXPECT_EQ(spec.methods[2].look, json({{"texture", {{"coverage_alpha", 0.0}, {"image", "smoke"}, {"size", 64}}}}))
        << "what it does not say is the scene's";
    EXPECT_EQ(spec.methods[1].parameters, spec.methods[0].parameters);
    EXPECT_EQ(spec.normalised["methods"][1]["shading"]["glsl"], "return tint;");
    EXPECT_FALSE(spec.normalised["methods"][0].contains("shading"));
    EXPECT_EQ(parse_spec(spec.normalised).normalised, spec.normalised);

    document["sweep"] = {{{"pointer", "/methods/1/shading/glsl"}, {"values", {"return tint;", "return tint * 0.5;"}}}};
    EXPECT_EQ(spec_at(parse_spec(document), parse_spec(document).points[1]).methods[1].look["shading"]["glsl"],
              "return tint * 0.5;");
}

TEST(Spec, WrongLooksAreNamedByTheirFields) {
    const auto method = [](const json& look) {
        json one = {{"id", "f2bd"}};
        one.update(look);
        return with("/methods/1", one);
    };
    EXPECT_THAT(wrong_fields(method({{"shading", "5-textures"}})), ElementsAre("/methods/1/shading"));
    EXPECT_THAT(wrong_fields(method({{"shading", {{"glsl", "#version 450"}}}})),
                ElementsAre("/methods/1/shading/glsl"));
    EXPECT_THAT(wrong_fields(method({{"texture", {{"size", 0}, {"wrap", 1}}}})),
                UnorderedElementsAre("/methods/1/texture/size", "/methods/1/texture/wrap"));
    EXPECT_THAT(wrong_fields(with("/reference", {{"id", "exact"}, {"shading", "constant"}})),
                ElementsAre("/reference/shading"))
        << "a reference is in the look of what is compared with it";
    json many = smallest();
    for (int i = 0; i < 9; ++i) many["methods"].push_back({{"id", "b2f"}, {"texture", {{"size", 8 + i}}}});
    EXPECT_THAT(wrong_fields(many), ElementsAre("/methods"));
    many["methods"].erase(2);
    EXPECT_THAT(wrong_fields(many), testing::IsEmpty());
}

TEST(Spec, EveryShaderIsListedOnce) {
    json document = with("/scene/shading", {{"glsl", "return tint;"}});
    document["methods"] = {"b2f",
                           {{"id", "f2b"}, {"label", "same"}, {"shading", {{"glsl", "return tint;"}}}},
                           {{"id", "f2b"}, {"label", "new"}, {"shading", {{"glsl", "return tint * 0.5;"}}}}};
    document["sweep"] = {{{"pointer", "/scene/count"}, {"values", {1, 2}}},
                         {{"pointer", "/scene/shading/glsl"}, {"values", {"return tint;", "return vec4(0.5);"}}}};
    std::vector<std::string> told;
    for (const SpecShader& shader : shaders_of(parse_spec(document)))
        told.push_back(shader.pointer + " " + shader.glsl);
    EXPECT_THAT(told, ElementsAre("/scene/shading/glsl return tint;", "/methods/2/shading/glsl return tint * 0.5;",
                                  "/sweep/1 return vec4(0.5);"));
}

TEST(Spec, ErrorsSayWhatIsAllowed) {
    try {
        parse_spec(with("/scene/count", 0));
        FAIL();
    } catch (const SpecError& error) {
        EXPECT_STREQ(error.what(), "/scene/count: must be from 1 to 65536, not 0");
    }
}

TEST(Spec, TextThatIsNotJsonIsOneError) {
    try {
        parse_spec_text("{\"scene\": ");
        FAIL();
    } catch (const SpecError& error) {
        ASSERT_EQ(error.errors().size(), 1u);
        EXPECT_EQ(error.errors()[0].pointer, "");
        EXPECT_THAT(error.errors()[0].detail, HasSubstr("line 1"));
    }
}

/// The schema must allow and forbid the same as the reader; spot checks of each kind of field.
TEST(Schema, AgreesWithTheReader) {
    const json schema = spec_schema();
    EXPECT_EQ(schema["additionalProperties"], false);
    EXPECT_EQ(schema["required"], json({"scene", "methods"}));
    EXPECT_EQ(schema["properties"]["image"]["properties"]["width"], json({{"type", "integer"},
                                                                          {"minimum", 1},
                                                                          {"maximum", 4096},
                                                                          {"default", 512},
                                                                          {"description", "columns [px]"}}));
    EXPECT_EQ(schema["properties"]["scene"]["oneOf"].size(), all_scenes().size());
    EXPECT_EQ(schema["properties"]["methods"]["items"]["oneOf"].size(), all_methods().size() + 1);
}

TEST(Catalog, DescribesParameters) {
    for (const json& method : describe_methods()) {
        if (method["id"] != "f2bd") continue;
        const json threshold = method["parameters"][0];
        EXPECT_EQ(threshold["name"], "threshold");
        EXPECT_EQ(threshold["kind"], "number");
        EXPECT_EQ(threshold["default"], 0.01);
        EXPECT_EQ(threshold["min"], 0);
        EXPECT_EQ(threshold["max"], 1);
        EXPECT_EQ(threshold.size(), 8u) << "members without information are left out: " << threshold;
        return;
    }
    FAIL() << "f2bd is not listed";
}

}  // namespace

}  // namespace sheer::spec_test
