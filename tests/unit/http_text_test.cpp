#include "server/http/text.h"

#include <gtest/gtest.h>

namespace sheer::http::http_text_test {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

TEST(HttpText, PreferredWait) {
    EXPECT_EQ(preferred_wait_s("wait=10"), 10);
    EXPECT_EQ(preferred_wait_s("respond-async, WAIT = 5; x=y"), 5);
    EXPECT_EQ(preferred_wait_s("wait=0"), 0);
    EXPECT_EQ(preferred_wait_s("wait=\"7\""), 7);
    EXPECT_EQ(preferred_wait_s(""), std::nullopt);
    EXPECT_EQ(preferred_wait_s("wait"), std::nullopt);
    EXPECT_EQ(preferred_wait_s("wait=-1"), std::nullopt);
    EXPECT_EQ(preferred_wait_s("wait=1.5"), std::nullopt);
    EXPECT_EQ(preferred_wait_s("wait=99999999999999"), std::nullopt);
    EXPECT_EQ(preferred_wait_s("await=3"), std::nullopt);
}

TEST(HttpText, EtagsAreComparedWeakly) {
    EXPECT_TRUE(names_etag("\"a\"", "\"a\""));
    EXPECT_TRUE(names_etag("\"b\", W/\"a\"", "\"a\""));
    EXPECT_TRUE(names_etag("*", "\"a\""));
    EXPECT_FALSE(names_etag("\"ab\"", "\"a\""));
    EXPECT_FALSE(names_etag("a", "\"a\""));
    EXPECT_FALSE(names_etag("", "\"a\""));
}

TEST(HttpText, JsonTypes) {
    EXPECT_TRUE(is_json_type("application/json"));
    EXPECT_TRUE(is_json_type("Application/JSON; charset=utf-8"));
    EXPECT_TRUE(is_json_type("application/vnd.sheer+json"));
    EXPECT_FALSE(is_json_type("text/plain"));
    EXPECT_FALSE(is_json_type("text/plain; application/json"));
    EXPECT_FALSE(is_json_type(""));
}

TEST(HttpText, HostNames) {
    EXPECT_EQ(host_name("LocalHost:8080"), "localhost");
    EXPECT_EQ(host_name("127.0.0.1"), "127.0.0.1");
    EXPECT_EQ(host_name("[::1]:8080"), "[::1]");
    EXPECT_EQ(host_name("[::1"), "[::1");
    EXPECT_EQ(host_name(""), "");
}

TEST(HttpText, PercentEscapes) {
    using Segments = std::vector<std::string>;
    EXPECT_EQ(query_pairs("q=a%20b+c"), (Pairs{{"q", "a b c"}}));
    EXPECT_EQ(path_segments("/a+%2f%2F"), Segments{"a+//"});
    for (const std::string broken : {"%", "%4", "%-1", "%g0"}) {
        EXPECT_EQ(query_pairs("q=" + broken), std::nullopt) << broken;
        EXPECT_EQ(path_segments("/" + broken), std::nullopt) << broken;
    }
}

TEST(HttpText, Paths) {
    using Segments = std::vector<std::string>;
    EXPECT_EQ(path_segments("/"), Segments{});
    EXPECT_EQ(path_segments("/a/b"), (Segments{"a", "b"}));
    EXPECT_EQ(path_segments("/a/"), (Segments{"a", ""}));
    EXPECT_EQ(path_segments("/a//b"), (Segments{"a", "", "b"}));
    EXPECT_EQ(path_segments("//a"), (Segments{"", "a"}));
    EXPECT_EQ(path_segments("/a/../b"), (Segments{"a", "..", "b"}));
    EXPECT_EQ(path_segments("/./a"), Segments{"a"}) << "a first dot says nothing (RFC 3986, 4.2)";
    EXPECT_EQ(path_segments(""), std::nullopt);
    EXPECT_EQ(path_segments("a/b"), std::nullopt);
    EXPECT_EQ(path_segments("*"), std::nullopt);
}

TEST(HttpText, Queries) {
    EXPECT_EQ(query_pairs(""), Pairs{});
    EXPECT_EQ(query_pairs("a=1&b=x%26y&c&&d=e=f"), (Pairs{{"a", "1"}, {"b", "x&y"}, {"c", ""}, {"d", "e=f"}}));
    EXPECT_EQ(query_pairs("=a&+b=c+"), (Pairs{{"", "a"}, {" b", "c "}}));
    EXPECT_EQ(query_pairs("a=%zz"), std::nullopt);
}

/// RFC 3986 allows them only as escapes, but browsers send most of them as they are.
TEST(HttpText, OtherCharactersAreKept) {
    const std::string others = "|^`{}[]<>\"\\#\xC3\xA9\xFF";
    EXPECT_EQ(query_pairs("q=" + others + "%25"), (Pairs{{"q", others + "%"}}));
    EXPECT_EQ(path_segments("/" + others), std::vector<std::string>{others});
}

TEST(HttpText, Events) {
    EXPECT_EQ(event_text(3, "done", "{}"), "id: 3\nevent: done\ndata: {}\n\n");
}

TEST(HttpText, Cursors) {
    const std::string id = "01900000-0000-7000-8000-0123456789ab";
    const std::string cursor = cursor_after(id);
    EXPECT_EQ(cursor.find(id), std::string::npos);
    EXPECT_EQ(id_of_cursor(cursor), id);
    EXPECT_EQ(id_of_cursor(""), std::nullopt);
    EXPECT_EQ(id_of_cursor(id), std::nullopt);
    EXPECT_EQ(id_of_cursor(cursor.substr(2)), std::nullopt);
    EXPECT_EQ(id_of_cursor(cursor + "00"), std::nullopt);
    EXPECT_EQ(id_of_cursor(cursor.substr(1)), std::nullopt);
}

}  // namespace
}  // namespace sheer::http::http_text_test
