#include "server/http/request_head.h"

#include <gtest/gtest.h>

namespace sheer::http::request_head_test {
namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;

Request request(const std::string& target, const Fields& fields = {{"Host", "here"}},
                const std::string& method = "GET") {
    Request made{.method = method, .target = target, .headers = {}, .body = {}, .path_values = {}};
    for (const auto& [name, value] : fields) made.headers.add(name, value);
    return made;
}

/// The status of the problem, 0 for none.
int problem_of(Request made, unsigned version = 11) {
    const auto problem = check_head(made, version);
    return problem ? problem->status : 0;
}

TEST(RequestHead, OfUsualRequestsIsAccepted) {
    EXPECT_EQ(problem_of(request("/")), 0);
    EXPECT_EQ(problem_of(request("/a?b=http://c")), 0);
    EXPECT_EQ(problem_of(request("*", {{"Host", "here"}}, "OPTIONS")), 0);
    EXPECT_EQ(problem_of(request("/", {}), 10), 0);
}

TEST(RequestHead, HasExactlyOneHost) {
    EXPECT_EQ(problem_of(request("/", {})), 400);
    EXPECT_EQ(problem_of(request("/", {{"Host", "a"}, {"host", "b"}})), 400);
    EXPECT_EQ(problem_of(request("/", {{"Host", "a"}, {"Host", "a"}}), 10), 400);
    EXPECT_EQ(problem_of(request("http://a/", {})), 400);
    for (const char* host : {"a b", "a/b", "user@a", "a?", "a#", "a\\b", "\"a\"", "a:b", "[::1"})
        EXPECT_EQ(problem_of(request("/", {{"Host", host}})), 400) << host;
    for (const char* host : {"", "a", "a:80", "[::1]:80", "10.0.0.1", "a_b.c-d", "m\xC3\xBCll"})
        EXPECT_EQ(problem_of(request("/", {{"Host", host}})), 0) << host;
}

TEST(RequestHead, HasNoEncodingOtherThanChunked) {
    const auto with = [](const std::string& encoding) {
        return request("/", {{"Host", "a"}, {"Transfer-Encoding", encoding}}, "POST");
    };
    EXPECT_EQ(problem_of(with("chunked")), 0);
    EXPECT_EQ(problem_of(with("Chunked")), 0);
    for (const char* encoding : {"xchunked", "gzip", "identity", "gzip, chunked", "chunked;q=1", "x"})
        EXPECT_EQ(problem_of(with(encoding)), 501) << encoding;
    for (const char* encoding : {"", ",", "chunked,", "chunked, chunked", "chunked, gzip", "chun ked", "\"chunked\""})
        EXPECT_EQ(problem_of(with(encoding)), 400) << encoding;
    EXPECT_EQ(problem_of(with("chunked"), 10), 400);
    const Fields twice = {{"Host", "a"}, {"Transfer-Encoding", "chunked"}, {"Transfer-Encoding", "chunked"}};
    EXPECT_EQ(problem_of(request("/", twice, "POST")), 400);
}

TEST(RequestHead, InAbsoluteFormIsReducedToThePath) {
    const auto told = [](const std::string& target) {
        Request made = request(target, {{"Host", "other"}});
        EXPECT_FALSE(check_head(made, 11)) << target;
        return made.target + " " + *made.headers.find("Host");
    };
    EXPECT_EQ(told("http://here:80/healthz"), "/healthz here:80");
    EXPECT_EQ(told("HTTP://here/a/b?c=d"), "/a/b?c=d here");
    EXPECT_EQ(told("https://[::1]:1"), "/ [::1]:1");
    EXPECT_EQ(told("http://here?a=b"), "/?a=b here");
    EXPECT_EQ(told("http://h\xC3\xA9/a|b?c={d}"), "/a|b?c={d} h\xC3\xA9");
    for (const char* target :
         {"healthz", "ftp://here/", "http:///x", "http://", "http:/x", "://x", "*", "http://a b/", "http://user@here/"})
        EXPECT_EQ(problem_of(request(target)), 400) << target;
}

TEST(RequestHead, OfAnotherVersionIsRefused) {
    EXPECT_EQ(problem_of(request("/"), 20), 505);
    EXPECT_EQ(problem_of(request("/"), 9), 505);
    EXPECT_EQ(problem_of(request("/"), 12), 0);
}

}  // namespace
}  // namespace sheer::http::request_head_test
