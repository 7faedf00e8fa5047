#include "server/jobs/foreign_input.h"

#include <gtest/gtest.h>

#include "renderer/spec/spec.h"

namespace sheer::foreign_input_test {

namespace {

using nlohmann::json;

const std::string sha256(64, 'a');

bool is_foreign(const json& scene, const json& method = {{"id", "b2f"}}, const json& more = json::object()) {
    json spec = {{"scene", scene}, {"methods", {method}}};
    spec.update(more);
    return has_foreign_input(parse_spec(spec).normalised);
}

TEST(ForeignInput, NumbersAndOurNamesAreNone) {
    EXPECT_FALSE(is_foreign({{"type", "quads"}, {"texture", {{"image", "leaf"}}}}));
    EXPECT_FALSE(is_foreign({{"type", "volume"}}, {{"id", "f2bd"}, {"label", "glsl"}}));
    EXPECT_FALSE(is_foreign({{"type", "quads"}}, "b2f", {{"title", "glsl"}, {"tags", {{"a", "glsl"}}}}));
}

TEST(ForeignInput, ProgramsAndUploadsAre) {
    const json glsl = {{"glsl", "return tint;"}};
    EXPECT_TRUE(is_foreign({{"type", "quads"}, {"shading", glsl}}));
    EXPECT_TRUE(is_foreign({{"type", "quads"}}, {{"id", "b2f"}, {"shading", glsl}}));
    EXPECT_TRUE(is_foreign({{"type", "quads"}}, "b2f",
                           {{"sweep", {{{"pointer", "/scene/shading"}, {"values", {"constant", glsl}}}}}}));
    EXPECT_TRUE(is_foreign({{"type", "quads"}, {"texture", {{"image", sha256}}}}));
    EXPECT_TRUE(is_foreign({{"type", "gltf"}, {"model", sha256}}));
    EXPECT_TRUE(is_foreign({{"type", "volume"}, {"volume", {{"data", sha256}}}}));
}

}  // namespace

}  // namespace sheer::foreign_input_test
