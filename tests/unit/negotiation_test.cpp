#include "server/http/negotiation.h"

#include <gtest/gtest.h>

namespace sheer::http::negotiation_test {
namespace {

TEST(Accept, TheMostPreciseRangeDecides) {
    EXPECT_TRUE(accepts(std::nullopt, "application/json"));
    EXPECT_TRUE(accepts("", "application/json"));
    EXPECT_TRUE(accepts("application/json", "application/json"));
    EXPECT_TRUE(accepts("text/html, application/xhtml+xml, */*;q=0.8", "application/json"));
    EXPECT_TRUE(accepts("APPLICATION/*", "application/json"));
    EXPECT_FALSE(accepts("text/html", "application/json"));
    EXPECT_FALSE(accepts("application/json;q=0", "application/json"));
    EXPECT_FALSE(accepts("*/*, application/json;q=0", "application/json"));
    EXPECT_FALSE(accepts("application/json;q=0.0, application/*", "application/json"));
    EXPECT_TRUE(accepts("application/*;q=0, application/json", "application/json"));
}

TEST(Accept, AnAnswerMayBeARange) {
    EXPECT_TRUE(accepts("image/png", "image/*"));
    EXPECT_TRUE(accepts("image/*", "image/*"));
    EXPECT_TRUE(accepts("text/html", "*/*"));
    EXPECT_FALSE(accepts("text/html", "image/*"));
}

TEST(AcceptEncoding, GzipByNameOrByStar) {
    EXPECT_FALSE(accepts_gzip(std::nullopt));
    EXPECT_FALSE(accepts_gzip(""));
    EXPECT_FALSE(accepts_gzip("br, deflate"));
    EXPECT_FALSE(accepts_gzip("gzip;q=0, *"));
    EXPECT_FALSE(accepts_gzip("*;q=0"));
    EXPECT_TRUE(accepts_gzip("deflate, gzip;q=0.5"));
    EXPECT_TRUE(accepts_gzip("GZIP"));
    EXPECT_TRUE(accepts_gzip("*"));
}

class Coding : public testing::Test {
  protected:
    Response answer(std::string body, const std::string& type) {
        Response response = text_response(200, std::move(body), type);
        response.headers.add("ETag", "\"x\"");
        choose_coding(response, m_request);
        return encoded(std::move(response), "/" + type, m_known);
    }

    Request m_request;
    BodyCache m_known{1 << 20};
};

TEST_F(Coding, LongTextsAreCompressedForThoseWhoAcceptIt) {
    const std::string text(1025, 'a');
    EXPECT_EQ(std::get<std::string>(answer(text, "text/plain").body), text);
    m_request.headers.add("Accept-Encoding", "gzip");
    const Response packed = answer(text, "application/problem+json");
    EXPECT_LT(std::get<std::string>(packed.body).size(), 100U);
    EXPECT_EQ(packed.headers.find("Content-Encoding"), "gzip");
    EXPECT_EQ(packed.headers.find("Vary"), "Accept-Encoding");
    EXPECT_EQ(packed.headers.find("ETag"), "\"x-gzip\"");
}

/// What has an ETag is compressed once, under its address.
TEST_F(Coding, CompressedFormsAreKept) {
    m_request.headers.add("Accept-Encoding", "gzip");
    const auto packed = [&](char letter, const std::string& type) {
        return std::get<std::string>(answer(std::string(2000, letter), type).body);
    };
    const std::string first = packed('a', "text/plain");
    EXPECT_EQ(packed('b', "text/plain"), first) << "the ETag says that it is the same";
    EXPECT_NE(packed('b', "text/css"), first);
    EXPECT_EQ(packed('a', "text/html"), first);
}

TEST_F(Coding, ShortOnesPicturesAndStreamsAreNot) {
    m_request.headers.add("Accept-Encoding", "gzip");
    EXPECT_FALSE(answer(std::string(1024, 'a'), "text/plain").headers.contains("Content-Encoding"));
    EXPECT_FALSE(answer(std::string(2000, 'a'), "image/png").headers.contains("Content-Encoding"));
    EXPECT_FALSE(answer(std::string(2000, 'a'), "text/event-stream").headers.contains("Content-Encoding"));
    EXPECT_TRUE(answer(std::string(2000, 'a'), "image/svg+xml").headers.contains("Content-Encoding"));
}

TEST_F(Coding, ETagsOfCompressedFormsLeadBackToTheOriginal) {
    m_request.headers.add("If-None-Match", "\"a-gzip\", W/\"b-gzip\"");
    m_request.headers.add("If-Match", "\"gzip\"");
    const Request request = without_coding(m_request);
    EXPECT_EQ(request.headers.find("If-None-Match"), "\"a\", W/\"b\"");
    EXPECT_EQ(request.headers.find("If-Match"), "\"gzip\"");
}

}  // namespace
}  // namespace sheer::http::negotiation_test
