// Compares the committed documents with the descriptions from which they are made.
#include "renderer/documents/documents.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "renderer/methods/shared/method.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/scene/scene_info.h"
#include "server/cli/service_config.h"
#include "server/http/components.h"
#include "tests/source_folder.h"

namespace sheer::documents_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string root = source_folder();

std::string text_of_file(const std::string& path) {
    std::ifstream file(root + "/" + path, std::ios::binary);
    EXPECT_TRUE(file) << "cannot read " << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<Document> all_documents() {
    return make_documents({cli::service_config_fields(), http::component_schemas()}, text_of_file);
}

std::string document(const std::string& path) {
    for (const Document& each : all_documents())
        if (each.path == path) return each.text;
    ADD_FAILURE() << "there is no document " << path;
    return "";
}

TEST(Documents, MatchTheSource) {
    for (const Document& each : all_documents())
        EXPECT_TRUE(text_of_file(each.path) == each.text) << each.path << " is out of date: run ./dev docs";
}

TEST(Documents, HaveEveryMethodSceneAndParameter) {
    const std::string methods = document("docs/methods.md"), configs = document("configs/README.md");
    for (const MethodInfo& method : all_methods()) {
        EXPECT_THAT(methods, HasSubstr("## " + method.name + "\n`" + method.id + "`"));
        for (const Param& param : method.parameters)
            EXPECT_THAT(methods, HasSubstr("| `/" + param.name + "` | ")) << method.id;
    }
    for (const SceneInfo& scene : all_scenes()) {
        EXPECT_THAT(configs, HasSubstr("### Scene `" + scene.id + "`"));
        for (const Param& param : scene.all_parameters())
            EXPECT_THAT(configs, HasSubstr("| `/scene/" + param.name + "` | ")) << scene.id;
    }
    for (const Param& param : cli::service_config_fields())
        EXPECT_THAT(configs, HasSubstr("| `/" + param.name + "` | "));
}

TEST(Documents, HaveEveryValueOfEveryMetric) {
    const std::string page = document("docs/metrics.md");
    for (const MetricInfo& metric : all_metrics()) {
        EXPECT_THAT(page, HasSubstr("\n| `" + metric.id + "` | "));
        EXPECT_THAT(page, HasSubstr(" | " + metric.good_for + " |\n"));
        for (const MetricField& field : metric.fields)
            EXPECT_THAT(page, HasSubstr("| `" + full_name(metric, field) + "` | " + field.summary + " |"));
    }
}

TEST(Documents, HaveEveryTypeOfEveryAnswer) {
    const std::string page = document("docs/report.md");
    for (const auto& [name, schema] : http::component_schemas()) {
        const std::size_t begin = page.find("\n### " + name + "\n");
        ASSERT_NE(begin, std::string::npos) << name;
        const std::string section = page.substr(begin, page.find("\n### ", begin + 1) - begin);
        const json properties = schema.value("properties", json::object());
        for (const auto& [field, property] : properties.items())
            EXPECT_THAT(section, HasSubstr("\n| `" + field + "` | ")) << name;
    }
}

TEST(Documents, TheSchemaOfAReportHasEverythingItRefersTo) {
    const json schema = json::parse(document("configs/schema/report.schema.json"));
    EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
    const json values = schema.flatten();
    std::size_t references = 0;
    for (const auto& [pointer, value] : values.items()) {
        if (!pointer.ends_with("/$ref")) continue;
        ++references;
        EXPECT_TRUE(schema.contains(json::json_pointer(value.get<std::string>().substr(1)))) << pointer;
    }
    EXPECT_GT(references, 10u);
}

TEST(Documents, SectionsOfSchemas) {
    const json one = {{"type", "object"},
                      {"description", "a thing"},
                      {"properties",
                       {{"a", {{"$ref", "#/x/Two"}, {"description", "this | that"}}},
                        {"b", {{"type", {"array", "null"}}, {"items", {{"type", "integer"}}}}},
                        {"c", {{"enum", {"x", nullptr}}}}}},
                      {"required", {"a"}}};
    const Schemas schemas = {
        {"One", one}, {"Two", {{"type", "object"}, {"additionalProperties", {{"$ref", "#/x/One"}}}}}, {"Zero", {}}};
    EXPECT_EQ(names_from(schemas, "One"), (std::vector<std::string>{"One", "Two"}));
    EXPECT_EQ(schema_sections(schemas, {"One", "Two"}),
              "\n### One\nA thing.\n"
              "\n| field | type | meaning |\n|---|---|---|\n"
              "| `a` | [Two](#two) | this \\| that |\n"
              "| `b` | array of whole number or null, or absent |  |\n"
              "| `c` | `x` or null, or absent |  |\n"
              "\n### Two\nIt is: object of [One](#one).\n");
}

TEST(Documents, APartIsWrittenBetweenItsMarksAndNothingElse) {
    const std::string page = "# A\n<!-- begin one (made) -->\nold\nold\n<!-- end one -->\nB\n";
    EXPECT_EQ(with_part(page, "one", "new\n"), "# A\n<!-- begin one (made) -->\nnew\n<!-- end one -->\nB\n");
    EXPECT_EQ(with_part(with_part(page, "one", "new\n"), "one", "old\nold\n"), page);
    EXPECT_THROW(with_part(page, "two", ""), std::runtime_error);
    EXPECT_THROW(with_part("<!-- end one -->\n<!-- begin one -->\n", "one", ""), std::runtime_error);
}

TEST(Documents, NameTheRequiredFieldsOfASpec) {
    const std::string configs = document("configs/README.md");
    for (const std::string field : {"scene", "methods"}) {
        const std::size_t begin = configs.find("| `/" + field + "` | ");
        ASSERT_NE(begin, std::string::npos) << field;
        EXPECT_THAT(configs.substr(begin, configs.find('\n', begin) - begin), HasSubstr("| required |")) << field;
    }
    const json schema = json::parse(document("configs/schema/spec.schema.json"));
    EXPECT_EQ(schema.at("required"), json({"scene", "methods"}));
    EXPECT_EQ(schema.at("$schema"), "http://json-schema.org/draft-07/schema#");
}

TEST(Documents, TableOfFields) {
    Param eye = Param::numbers("eye", "where from", "m", {0, 0.5, 1}, -10, 10).of({"x", "y", "z"});
    Param near = Param::number("near", "how near", "m", 0.25, 0, 1);
    near.exclusive = true;
    Param seed = Param::integer("seed", "a | b", "", 7, 0, 4294967295.0);
    Param open = Param::number("open", "either way", "", 1e-7, 1, 2).required();
    open.max = std::numeric_limits<double>::infinity();
    Param none = Param::text("none", "nothing", "", 20);
    none.optional = true;
    none.default_value = nullptr;
    Param light = Param::object("light", "may be left out", {Param::boolean("on", "shines", true)});
    light.optional = true;
    const std::vector<Param> fields = {
        Param::object("camera", "the view", {eye, near}),
        light,
        seed,
        open,
        none,
        Param::choice("mode", "which", "a", {"a", "b"}),
        Param::boolean("on", "whether", true),
        Param::list("parts", "some", {Param::integer("count", "how many", "", 1, 1, 2'000'000).required()}, 0, 9)};
    EXPECT_EQ(field_table(to_json(fields), "/scene"),
              "| field | what | type | unit | range | default |\n"
              "|---|---|---|---|---|---|\n"
              "| `/scene/camera` | the view | object |  |  |  |\n"
              "| `/scene/camera/eye` | where from | array of 3 numbers: x, y, z | m | -10 to 10 | `[0, 0.5, 1]` |\n"
              "| `/scene/camera/near` | how near | number | m | 0 to 1, both excluded | `0.25` |\n"
              "| `/scene/light` | may be left out | object |  |  | none |\n"
              "| `/scene/light/on` | shines | true or false |  |  | `true` |\n"
              "| `/scene/seed` | a \\| b | integer |  | 0 to 4294967295 | `7` |\n"
              "| `/scene/open` | either way | number |  | at least 1 | required |\n"
              "| `/scene/none` | nothing | text of 0 to 20 bytes |  |  | none |\n"
              "| `/scene/mode` | which | one of `a`, `b` |  |  | `\"a\"` |\n"
              "| `/scene/on` | whether | true or false |  |  | `true` |\n"
              "| `/scene/parts` | some | array of 0 to 9 objects |  |  | `[]` |\n"
              "| `/scene/parts/*/count` | how many | integer |  | 1 to 2000000 | required |\n");
}

TEST(Documents, HaveNoBoundsWithExponents) {
    for (const Document& each : all_documents())
        EXPECT_THAT(each.text, Not(testing::ContainsRegex("[0-9]e\\+[0-9]"))) << each.path;
}

}  // namespace

}  // namespace sheer::documents_test
