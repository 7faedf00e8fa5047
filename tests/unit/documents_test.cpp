// The committed documents against the descriptions that they are made from.
#include "renderer/spec/documents.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "renderer/methods/method.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/litmus_page.h"
#include "server/cli/service_config.h"

namespace sheer::documents_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string root = SHEER_SOURCE_DIR;

std::string text_of_file(const std::string& path) {
    std::ifstream file(root + "/" + path, std::ios::binary);
    EXPECT_TRUE(file) << "cannot read " << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<Document> all_documents() {
    return make_documents(cli::service_config_fields(), json::parse(text_of_file("tests/render/litmus.json")));
}

std::string document(const std::string& path) {
    for (const Document& each : all_documents())
        if (each.path == path) return each.text;
    ADD_FAILURE() << "there is no document " << path;
    return "";
}

TEST(Documents, AreThoseOfTheSource) {
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

TEST(Documents, SayWhatASpecMustHave) {
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
    Param eye = Param::numbers("eye", "where from", "m", {0, 0.5, 1}, -10, 10);
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
              "| `/scene/camera/eye` | where from | array of 3 numbers | m | -10 to 10 | `[0, 0.5, 1]` |\n"
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

TEST(Documents, LitmusPage) {
    const json litmus = {
        {"scenes",
         {{{"id", "a"}, {"name", "First"}, {"what", "One."}}, {{"id", "b"}, {"name", "Second"}, {"what", "Two."}}}},
        {"methods",
         {{{"name", "f2b"},
           {"variants", {{{"id", "f2b"}}}},
           {"rows",
            {{{"scenes", {"b"}}, {"expect", "passes"}, {"why", "it can"}},
             {{"scenes", {"a"}}, {"expect", "fails"}, {"why", "it cannot"}}}}}}}};
    const std::string page = litmus_page(litmus);
    EXPECT_THAT(page, HasSubstr("| First | One. |\n| Second | Two. |\n"));
    EXPECT_THAT(page, HasSubstr("| method | First | Second |\n|---|---|---|\n| f2b | **fails** | passes |\n"));
    EXPECT_THAT(page, HasSubstr("### f2b\nTested as `{\"id\":\"f2b\"}`.\n\n"
                                "- Second: **passes**, because it can.\n- First: **fails**, because it cannot.\n"));
    EXPECT_THROW(litmus_page(json::object()), json::exception);
}

TEST(Documents, HaveNoBoundsWithExponents) {
    for (const Document& each : all_documents())
        EXPECT_THAT(each.text, Not(testing::ContainsRegex("[0-9]e\\+[0-9]"))) << each.path;
}

}  // namespace

}  // namespace sheer::documents_test
