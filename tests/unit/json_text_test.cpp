#include "renderer/params/json_text.h"

#include <gmock/gmock.h>

#include "renderer/spec/spec.h"

namespace sheer::json_text_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::string why_not(const std::string& text) {
    try {
        read_json(text);
    } catch (const NotJson& error) {
        return error.what();
    }
    return "";
}

std::vector<std::string> twice(const std::string& text) {
    std::vector<std::string> pointers;
    try {
        read_json(text);
    } catch (const SpecError& error) {
        for (const FieldError& field : error.errors()) {
            EXPECT_EQ(field.detail, "is given twice");
            pointers.push_back(field.pointer);
        }
    }
    return pointers;
}

TEST(JsonText, IsReadCompletely) {
    EXPECT_EQ(read_json(R"( {"a": [1, -2.5, true, null, "x"], "b": {}} )"),
              (json{{"a", {1, -2.5, true, nullptr, "x"}}, {"b", json::object()}}));
    EXPECT_EQ(read_json("\xef\xbb\xbf[]"), json::array());
    EXPECT_EQ(read_json("7"), 7);
}

TEST(JsonText, WithAnythingAfterItIsRefused) {
    using namespace std::string_literals;
    for (const char* text : {"{}x", "{} {}", "[1],", "1 2", "{}\xff", "\"a\"\"b\""})
        EXPECT_NE(why_not(text), "") << text;
    for (const std::string& text : {"{}\0"s, "{}\0{\"garbage\""s, "[1]\n\0\n"s, "\0"s, "[1,\0 2]"s})
        EXPECT_NE(why_not(text), "") << json(text).dump();
    EXPECT_THAT(why_not("{}\0x"s), HasSubstr("NUL at byte 3"));
}

TEST(JsonText, IfMalformedGivesThePosition) {
    EXPECT_THAT(why_not("{\"a\": ,}"), HasSubstr("line 1, column 7"));
    EXPECT_NE(why_not(""), "");
    EXPECT_NE(why_not("\"\xff\""), "");
    EXPECT_THAT(why_not("[1e999]"), HasSubstr("out of range"));
    EXPECT_EQ(why_not(std::string(64, '[') + std::string(64, ']')), "");
    EXPECT_THAT(why_not(std::string(65, '[') + std::string(65, ']')), HasSubstr("64 levels"));
    EXPECT_THAT(why_not(std::string(500'000, '[')), HasSubstr("64 levels"));
}

TEST(JsonText, WithAKeyTwiceIsRefusedAtTheKey) {
    EXPECT_THAT(twice(R"({"a": 1, "b": 2, "a": 1})"), ElementsAre("/a"));
    EXPECT_THAT(twice(R"({"m": [0, [], {"x": {"y": 1, "z": [1, 2], "y": 3}}]})"), ElementsAre("/m/2/x/y"));
    EXPECT_THAT(twice(R"([{"a/b": 1, "a/b": 1}, {"~": 1, "~": 1}])"), ElementsAre("/0/a~1b", "/1/~0"));
    // The same key, spelled in two ways.
    EXPECT_THAT(twice(R"({"a": 1, "\u0061": 1})"), ElementsAre("/a"));
    EXPECT_THAT(twice(R"([{"a": 1}, {"a": 1}, {"b": {"a": 1}, "a": 2}])"), ElementsAre());
}

TEST(JsonText, OfASpecFollowsTheSameRules) {
    const std::string spec = R"({"scene": {"type": "quads"}, "methods": ["b2f"], "image": {"width": 8, "width": 9}})";
    try {
        parse_spec_text(spec);
        FAIL();
    } catch (const SpecError& error) {
        EXPECT_STREQ(error.what(), "/image/width: is given twice");
    }
    EXPECT_THROW(parse_spec_text(R"({"scene": {"type": "quads"}, "methods": ["b2f"]} trailing)"), SpecError);
    EXPECT_NO_THROW(parse_spec_text(R"({"scene": {"type": "quads"}, "methods": ["b2f"]})"));
}

}  // namespace

}  // namespace sheer::json_text_test
