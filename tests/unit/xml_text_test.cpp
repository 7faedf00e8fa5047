// JUnit files are XML whatever the texts contain, checked by independent rules: XML 1.0 (fifth edition) and RFC 3629.
#include "renderer/report/xml_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>

#include "renderer/report/report.h"
#include "temporary_folder.h"

namespace sheer::xml_text_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The characters of UTF-8 text, or a failure that names the first invalid byte.
std::vector<char32_t> decoded(const std::string& text) {
    std::vector<char32_t> all;
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80   ? 1
                                   : lead < 0xC2 ? 0
                                   : lead < 0xE0 ? 2
                                   : lead < 0xF0 ? 3
                                   : lead < 0xF5 ? 4
                                                 : 0;
        if (length == 0 || i + length > text.size()) {
            ADD_FAILURE() << "byte " << i << " is not UTF-8";
            return all;
        }
        char32_t c = length == 1 ? lead : lead & (0x7Fu >> length);
        for (std::size_t k = 1; k < length; ++k) c = c << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3Fu);
        all.push_back(c);
        i += length;
    }
    return all;
}

void expect_xml_characters(const std::string& text) {
    for (const char32_t c : decoded(text)) {
        const bool good = c == 9 || c == 10 || c == 13 || (c >= 0x20 && c < 0xD800) || (c >= 0xE000 && c < 0xFFFE) ||
                          (c >= 0x10000 && c <= 0x10FFFF);
        EXPECT_TRUE(good) << "U+" << std::hex << static_cast<std::uint32_t>(c);
    }
}

/// What remains of a document after its tags are removed one after the other; "" for a well-formed one with only what
/// JUnit files use: a declaration, elements, attributes in double quotes, and the references that XML itself defines.
std::string not_well_formed(std::string xml) {
    const std::string reference = "&(?:amp|lt|gt|quot|apos|#[0-9]+);", text = "(?:[^<>&]|" + reference + ")*";
    const std::string attributes = "(?: [a-z]+=\"(?:[^<&\"]|" + reference + ")*\")*";
    xml = std::regex_replace(xml, std::regex(R"(^<\?xml version="1\.0" encoding="UTF-8"\?>)"), "");
    const std::regex inner("<([a-z]+)" + attributes + "(?: ?/>|>" + text + R"(</\1>))");
    for (std::string before; before != xml;) {
        before = xml;
        xml = std::regex_replace(xml, inner, "");
    }
    return std::regex_replace(xml, std::regex("^\n*|\n*$"), "");
}

TEST(XmlText, KeepsCharactersThatXmlAllows) {
    const std::string text = "a<b> & \"c\" 'd'\t\r\n\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80 ]]>\x7F";
    EXPECT_EQ(xml_text(text), text);
    EXPECT_EQ(xml_text(""), "");
}

TEST(XmlText, ReplacesCharactersThatXmlDoesNotAllow) {
    const std::string gone = "\xEF\xBF\xBD";
    for (int c = 0; c < 0x20; ++c) {
        if (c == '\t' || c == '\n' || c == '\r') continue;
        EXPECT_EQ(xml_text(std::string(1, static_cast<char>(c))), gone) << c;
    }
    EXPECT_EQ(xml_text("\xEF\xBF\xBF"), gone) << "U+FFFF";
    EXPECT_EQ(xml_text("\xEF\xBF\xBE"), gone) << "U+FFFE";
    EXPECT_EQ(xml_text("\xEF\xBF\xBC"), "\xEF\xBF\xBC") << "U+FFFC is allowed";
    EXPECT_EQ(xml_text("\xED\xA0\x80"), gone) << "a lone surrogate";
    EXPECT_EQ(xml_text("a\x80z"), "a" + gone + "z") << "a continuation byte without a start";
    EXPECT_EQ(xml_text("\xC0\xAF"), gone + gone) << "an overlong form";
    EXPECT_EQ(xml_text("\xF4\x90\x80\x80"), gone) << "beyond U+10FFFF";
    EXPECT_EQ(xml_text("a\xE2\x82"), "a" + gone + gone) << "cut off";
}

report::Report failed_report(const std::string& spec_title, const std::string& title, const std::string& detail) {
    return from_document<report::Report>({{"status", "failed"},
                                          {"error", {{"title", title}, {"detail", detail}}},
                                          {"spec", {{"title", spec_title}}},
                                          {"created_at", "2026-01-01T00:00:00.000Z"}});
}

TEST(Junit, IsXmlForAnyBytes) {
    std::mt19937 random(7);
    for (int round = 0; round < 300; ++round) {
        std::string bytes(40, '\0');
        for (char& byte : bytes) byte = static_cast<char>(round % 2 == 0 ? random() % 256 : 0xE0 + random() % 32);
        const std::string xml = report_junit(failed_report(bytes, bytes, bytes));
        expect_xml_characters(xml);
        EXPECT_EQ(not_well_formed(xml), "");
    }
}

TEST(Junit, XmllintAcceptsAThousandRandomTitles) {
    if (std::system("xmllint --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no xmllint";
    const test::TemporaryFolder folder;
    std::mt19937 random(11);
    for (int i = 0; i < 1000; ++i) {
        std::string title(1 + random() % 60, '\0');
        for (char& byte : title) byte = static_cast<char>(random() % 256);
        std::ofstream(folder.path() / (std::to_string(i) + ".xml")) << report_junit(failed_report(title, title, title));
    }
    const std::string command = "find '" + folder.path().string() + "' -name '*.xml' -exec xmllint --noout {} +";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Junit, EscapesMarkupAndKeepsLines) {
    const std::string text = "a<b> & \"c\" ]]>\ttwo\r\nthree";
    const std::string xml = report_junit(failed_report(text, "title", text));
    EXPECT_THAT(xml, HasSubstr("name=\"a&lt;b> &amp; &quot;c&quot; ]]>&#09;two&#13;&#10;three\""));
    EXPECT_THAT(xml, HasSubstr(">a&lt;b&gt; &amp; \"c\" ]]&gt;\ttwo\r\nthree</error>"));
}

json check_of(const std::string& label, const json& value, bool passed) {
    return {{"metric", "flip.mean"}, {"method", label}, {"at", {{"/scene/count", 16}}}, {"min", nullptr}, {"max", 0.05},
            {"value", value},        {"passed", passed}};
}

TEST(Junit, IsWellFormedForAnyTexts) {
    const std::string odd =
        "a\x01"
        "b \xEF\xBF\xBF & <x> \"q\" ]]>\x0B \xFF\n--> 'e'";
    const json result = {{"label", odd}, {"status", "failed"}, {"reason", odd}, {"notes", json::array()}};
    const json report = {
        {"status", "done"},
        {"spec", {{"title", odd}}},
        {"created_at", "2026-01-01T00:00:00.000Z"},
        {"notes", {{{"code", "a-b"}, {"text", odd}, {"where", odd}}}},
        {"checks", {check_of(odd, 0.2, false), check_of(odd, nullptr, false), check_of(odd, 0.01, true)}},
        {"runs", {{{"point", {{"/scene/count", 16}}}, {"results", {result}}}}}};
    const std::string xml = report_junit(from_document<report::Report>(report));
    expect_xml_characters(xml);
    EXPECT_EQ(not_well_formed(xml), "");
    EXPECT_THAT(xml, HasSubstr("tests=\"4\" failures=\"3\" errors=\"0\" skipped=\"0\""));
    EXPECT_THAT(xml, HasSubstr("<failure message=\"is 0.2, wanted at most 0.05\" />"));
    EXPECT_THAT(xml, HasSubstr("at count 16 (2)\">"));
}

TEST(Junit, AReportThatIsNotDoneHasAnError) {
    const std::string xml = report_junit(failed_report("T", "Rendering failed", "The renderer died (signal 11)."));
    EXPECT_EQ(not_well_formed(xml), "");
    EXPECT_THAT(xml, HasSubstr("<testsuite name=\"T\" tests=\"1\" failures=\"0\" errors=\"1\""));
    EXPECT_THAT(xml, HasSubstr("<error message=\"Rendering failed\">The renderer died (signal 11).</error>"));
    EXPECT_THAT(report_junit(from_document<report::Report>({{"status", "cancelled"}, {"error", nullptr}})),
                HasSubstr("<error message=\"The comparison is cancelled\" />"));
}

}  // namespace
}  // namespace sheer::xml_text_test
