#include "server/http/router.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/http/problem.h"

namespace sheer::http::router_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

Route route(std::string method, std::string pattern) {
    Route made;
    made.method = std::move(method);
    made.pattern = std::move(pattern);
    return made;
}

class RouterTest : public testing::Test {
  protected:
    RouterTest() {
        m_router.add({route("GET", "/"), route("GET", "/things"), route("POST", "/things"),
                      route("GET", "/things/{id}"), route("DELETE", "/things/{id}"),
                      route("GET", "/things/{id}/part")});
    }

    std::string pattern(const char* method, const char* path) {
        const Match match = m_router.match(method, path);
        return match.route ? match.route->method + " " + match.route->pattern : "";
    }

    Router m_router;
};

TEST_F(RouterTest, FindsTheRoute) {
    EXPECT_EQ(pattern("GET", "/"), "GET /");
    EXPECT_EQ(pattern("GET", "/things"), "GET /things");
    EXPECT_EQ(pattern("POST", "/things"), "POST /things");
    EXPECT_EQ(pattern("DELETE", "/things/5"), "DELETE /things/{id}");
    EXPECT_EQ(pattern("GET", "/things/5/part"), "GET /things/{id}/part");
    EXPECT_EQ(pattern("HEAD", "/things/5"), "GET /things/{id}");
}

TEST_F(RouterTest, DecodesTheValueOfAName) {
    EXPECT_EQ(m_router.match("GET", "/things/a%2Fb%20c").path_values.at("id"), "a/b c");
}

TEST_F(RouterTest, KnowsNoOtherPaths) {
    for (const char* path :
         {"", "things", "/things/", "/things/5/", "/things//part", "/other", "/things/5/part/x", "/things/%zz"})
        EXPECT_THAT(m_router.match("GET", path).allowed, IsEmpty()) << path;
}

TEST_F(RouterTest, SaysWhatIsAllowed) {
    const Match match = m_router.match("PUT", "/things/5");
    EXPECT_EQ(match.route, nullptr);
    EXPECT_THAT(match.allowed, ElementsAre("GET", "HEAD", "DELETE", "OPTIONS"));
    EXPECT_EQ(m_router.match("get", "/things").route, nullptr);
}

TEST(ReadQuery, ReadsByDescription) {
    const std::vector<Param> fields{Param::integer("limit", "", "", 20, 1, 100), Param::text("q", "", "", 10)};
    EXPECT_EQ(read_query("", fields), (json{{"limit", 20}, {"q", ""}}));
    EXPECT_EQ(read_query("q=12&limit=5", fields), (json{{"limit", 5}, {"q", "12"}}));
}

TEST(ReadQuery, NamesEveryWrongField) {
    const std::vector<Param> fields{Param::integer("limit", "", "", 20, 1, 100), Param::text("q", "", "", 10)};
    try {
        read_query("limit=1e3&q=a&q=b&other=1", fields);
        FAIL();
    } catch (const Problem& wrong) {
        const Response response = wrong.response();
        EXPECT_EQ(response.status, 400);
        const json body = json::parse(std::get<std::string>(response.body));
        std::vector<std::string> pointers;
        for (const json& error : body["errors"]) pointers.push_back(error["pointer"]);
        EXPECT_THAT(pointers, testing::UnorderedElementsAre("/limit", "/q", "/other"));
    }
    EXPECT_THROW(read_query("q=%", fields), Problem);
}

TEST(ProblemTest, IsRfc9457) {
    const Response response = problem(422, "bad \xff text", {{"/a/0", "too \"big\""}});
    EXPECT_EQ(response.status, 422);
    EXPECT_EQ(response.headers.find("content-type"), "application/problem+json");
    const json body = json::parse(std::get<std::string>(response.body));
    EXPECT_EQ(body["status"], 422);
    EXPECT_EQ(body["title"], "Unprocessable Content");
    EXPECT_EQ(body["type"], "about:blank");
    EXPECT_EQ(body["errors"], (json::array({{{"pointer", "/a/0"}, {"detail", "too \"big\""}}})));
    EXPECT_FALSE(json::parse(std::get<std::string>(problem(404, "none").body)).contains("errors"));
}

}  // namespace
}  // namespace sheer::http::router_test
