// The self-contained page as text; tests/web opens it in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "renderer/files/html.h"

namespace sheer::report_html_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

json image(const std::string& sha256, const std::string& media_type = "image/png") {
    return {{"sha256", sha256}, {"url", "/api/v1/blobs/" + sha256}, {"media_type", media_type}};
}

/// A report with the parts from which the page's file is made.
json report_titled(const std::string& title) {
    const json reference = {{"method", "exact"},
                            {"images", {{"color", image("aa")}, {"linear", image("ee", "image/x-exr")}}}};
    const json same = {{"label", "b2f"}, {"images", {{"color", image("aa")}, {"flip", image("ff")}}}};
    const json failed = {{"label", "f2b"}, {"status", "failed"}, {"images", json::object()}};
    const json methods = json::array({{{"id", "b2f"}, {"label", "b2f"}}, {{"id", "f2b"}, {"label", "f2b"}}});
    return {{"spec", {{"title", title}, {"methods", methods}, {"baseline", "b2f"}}},
            {"runs", {{{"reference", reference}, {"results", {same, failed}}}}}};
}

std::string page_of(const json& report, std::vector<std::string>* read = nullptr) {
    return report_html(from_document<report::Report>(report), [read](const report::Picture& picture) {
        if (read != nullptr) read->push_back(picture.sha256);
        return "bytes of " + picture.sha256;
    });
}

json data_block(const std::string& page) {
    const std::string begin = R"(<script type="application/json" id="sheer-report">)";
    const std::size_t start = page.find(begin) + begin.size();
    return json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(ReportHtml, ContainsTheReportUnchanged) {
    const json report = report_titled("</script><script>alert(1)</script> <!-- \u201cx\u201d & 'y'");
    const json data = data_block(page_of(report));
    EXPECT_EQ(data.at("report"), to_document(from_document<report::Report>(report)));
    EXPECT_EQ(data.at("report").at("spec"), report.at("spec"));
    EXPECT_FALSE(data.at("methods").empty());
    EXPECT_FALSE(data.at("metrics").empty());
}

TEST(ReportHtml, TextFromUsersCannotBecomeMarkup) {
    const std::string plain = page_of(report_titled("x"));
    const std::string page = page_of(report_titled("</title></script><script>alert(1)</script><!--"));
    EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
    EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
    EXPECT_EQ(count(page, "</title>"), 1u);
    EXPECT_EQ(count(page, "<!--"), 0u);
    EXPECT_THAT(page, HasSubstr("<title>&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)"));
}

TEST(ReportHtml, EmbedsEachPictureOnce) {
    std::vector<std::string> read;
    const json pictures = data_block(page_of(report_titled("x"), &read)).at("pictures");
    EXPECT_THAT(read, ::testing::UnorderedElementsAre("aa", "ee", "ff"));
    // base64 of "bytes of aa", "bytes of ee" and "bytes of ff" by coreutils.
    EXPECT_EQ(pictures, (json{{"aa", "data:image/png;base64,Ynl0ZXMgb2YgYWE="},
                              {"ee", "data:image/x-exr;base64,Ynl0ZXMgb2YgZWU="},
                              {"ff", "data:image/png;base64,Ynl0ZXMgb2YgZmY="}}));
}

TEST(ReportHtml, IsSelfContained) {
    const std::string page = page_of(report_titled("x"));
    const std::regex fetched(R"re((src|href)="([^"]*)")re");
    for (std::sregex_iterator found(page.begin(), page.end(), fetched), end; found != end; ++found)
        EXPECT_TRUE((*found)[2].str().starts_with("data:")) << (*found)[2];
    EXPECT_THAT(page, Not(HasSubstr("@import")));
    EXPECT_THAT(page, Not(HasSubstr("url(")));
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(ReportHtml, EveryScriptHasTheNonceOfThisReport) {
    const auto nonce_of = [](const std::string& page) {
        std::smatch found;
        EXPECT_TRUE(std::regex_search(page, found, std::regex("'nonce-([0-9a-f]{32})'")));
        return found[1].str();
    };
    const std::string page = page_of(report_titled("x"));
    const std::string nonce = nonce_of(page);
    // The style, the theme, the import map and the entry; the block of data is not executed.
    EXPECT_EQ(count(page, "nonce=\"" + nonce + "\""), 4u);
    EXPECT_EQ(count(page, "<script nonce=") + count(page, "<script type=\"importmap\" nonce=") +
                  count(page, "<script type=\"module\" nonce="),
              3u);
    EXPECT_EQ(count(page, "<script"), 4u);
    EXPECT_NE(nonce, nonce_of(page_of(report_titled("y"))));
}

TEST(ReportHtml, FailsIfAPictureCannotBeRead) {
    const auto report = from_document<report::Report>(report_titled("x"));
    const auto read = [](const report::Picture&) -> std::string { throw std::runtime_error("gone"); };
    EXPECT_THROW(report_html(report, read), std::runtime_error);
}

}  // namespace
}  // namespace sheer::report_html_test
