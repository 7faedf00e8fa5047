#include "server/http/path_prefix.h"

#include <gtest/gtest.h>

namespace sheer::http::path_prefix_test {
namespace {

TEST(PathPrefix, IsTakenFromTargetsWhetherOrNotAProxyDidIt) {
    const PathPrefix prefix("/sheer");
    EXPECT_EQ(prefix.stripped("/sheer/api/v1/reports?limit=1"), "/api/v1/reports?limit=1");
    EXPECT_EQ(prefix.stripped("/api/v1/reports"), "/api/v1/reports");
    EXPECT_EQ(prefix.stripped("/sheers/api"), "/sheers/api");
    EXPECT_EQ(PathPrefix().stripped("/sheer/api"), "/sheer/api");
    EXPECT_EQ(prefix.redirection("/sheer?x")->headers.find("Location"), "/sheer/");
    EXPECT_FALSE(prefix.redirection("/sheer/"));
}

TEST(PathPrefix, IsPutBeforeLocationsAndUrlsOnly) {
    Response response = text_response(
        202, R"({"url":"/api/v1/a","x":{"url" : "/api/v1/b","picture":"/thumbnails/c","urls":"/api/v1/d"},"e":"/f"})",
        "application/json");
    response.headers.add("Location", "/api/v1/a");
    response = PathPrefix("/p").put_before(std::move(response));
    EXPECT_EQ(response.headers.find("Location"), "/p/api/v1/a");
    EXPECT_EQ(
        std::get<std::string>(response.body),
        R"({"url":"/p/api/v1/a","x":{"url" : "/p/api/v1/b","picture":"/p/thumbnails/c","urls":"/api/v1/d"},"e":"/f"})");
}

TEST(PathPrefix, TextsThatOnlyLookLikeUrlsStay) {
    for (const char* text : {R"({"title":"\"url\":\"/a\""})", R"({"tags":{"url":"/api/v1/a","b":"}"},"x":1})",
                             R"({"url":"data:,"})", R"(["url","/api/v1/a"])", R"({"url":"/other"})", R"({"url":null})",
                             R"({"a":"\\","b":"\\\"url\":\"/"})", R"("url)", ""})
        EXPECT_EQ(json_with_prefix(text, "/p"), text);
    EXPECT_EQ(json_with_prefix(R"({"tags":{"url":"/api/v1/a"},"url":"/api/v1/b"})", "/p"),
              R"({"tags":{"url":"/api/v1/a"},"url":"/p/api/v1/b"})");
}

TEST(PathPrefix, OnlyPlainPathsAreTaken) {
    for (const char* good : {"", "/sheer", "/a/b-c.d"}) EXPECT_EQ(wrong_path_prefix(good), "") << good;
    for (const char* wrong : {"/", "sheer", "/sheer/", "/a//b", "/a b", "/a\"", "/a?b", "/%41"})
        EXPECT_NE(wrong_path_prefix(wrong), "") << wrong;
}

}  // namespace
}  // namespace sheer::http::path_prefix_test
