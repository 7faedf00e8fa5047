#include <gmock/gmock.h>

#include "renderer/core/errors.h"
#include "renderer/core/sha256.h"
#include "renderer/diff/diff.h"
#include "renderer/files/report_document.h"
#include "renderer/pictures/picture_file.h"
#include "tests/unit/map_sink.h"
#include "tests/unit/schema_walk.h"

namespace sheer::report_diff_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two reports of 4 x 2 black pixels, with the methods b2f (the baseline), f2b and f2bd.
class ReportDiff : public testing::Test {
  protected:
    ReportDiff() {
        a = make();
        b = make();
    }

    json image(const Image8& picture) {
        const std::string png = encode_png(picture), sha256 = sha256_hex(png);
        m_files[sha256] = png;
        return {{"sha256", sha256}, {"url", sha256}, {"media_type", "image/png"}};
    }

    /// Six rounds of `base_ms`, a hundredth more each round.
    static json timing(double base_ms) {
        json samples = json::array();
        for (int round = 0; round < 6; ++round) samples.push_back(base_ms * (1 + 0.01 * round));
        return {{"clock", "wall"}, {"samples", samples}, {"gpu_samples", samples}, {"wall_samples", samples}};
    }

    json make() {
        const json picture = image(Image8(4, 2));
        json results = json::array(), methods = json::array();
        for (const char* id : {"b2f", "f2b", "f2bd"}) {
            methods.push_back({{"id", id}, {"label", id}});
            results.push_back({{"method", id},
                               {"label", id},
                               {"status", "ok"},
                               {"reason", nullptr},
                               {"images", {{"color", picture}}},
                               {"timing", timing(10)}});
        }
        return {{"status", "done"},
                {"created_at", "2026-01-01T00:00:00.000Z"},
                {"spec",
                 {{"title", "t"},
                  {"image", {{"width", 4}, {"height", 2}}},
                  {"scene", {{"type", "quads"}, {"count", 3}}},
                  {"methods", methods},
                  {"baseline", "b2f"},
                  {"timing", {{"rounds", 6}}}}},
                {"device", {{"renderer", "r"}, {"cpu", "c"}}},
                {"provenance", {{"version", "1"}, {"commit", "abc"}}},
                {"runs",
                 {{{"point", json::object()},
                   {"noise_floor", {{"factor", 1.02}}},
                   {"reference", {{"method", "exact"}, {"images", {{"color", picture}}}}},
                   {"results", results}}}}};
    }

    json& result(json& report, std::size_t index) { return report["runs"][0]["results"][index]; }

    json diff(const DiffOptions& options = {}) {
        const auto read = [this](const report::Picture& picture) { return m_files.at(picture.url); };
        const report::Report of_a = read_report(a), of_b = read_report(b);
        return to_document(diff_reports({of_a, read}, {of_b, read}, options));
    }

    static bool is_worse(const json& diff, const DiffTolerance& tolerance = {}) {
        return !changes_for_the_worse(from_document<diff::Diff>(diff), tolerance).empty();
    }
    static std::string diff_table(const json& diff) { return sheer::diff_table(from_document<diff::Diff>(diff)); }

    json of(std::size_t index, const char* part) { return diff()["runs"][0]["results"][index][part]; }

    std::vector<std::string> conflicts(const std::vector<std::string>& allow = {}) {
        std::vector<std::string> pointers;
        try {
            diff({.allow = allow});
        } catch (const SpecError& wrong) {
            for (const FieldError& error : wrong.errors()) pointers.push_back(error.pointer);
        }
        return pointers;
    }

    /// The pointers that the refusal offers to allow.
    std::vector<std::string> offered(const std::vector<std::string>& allow = {}) {
        try {
            diff({.allow = allow});
        } catch (const DiffConflict& conflict) {
            return conflict.allowable();
        }
        ADD_FAILURE() << "it was not refused";
        return {};
    }

    json a, b;
    std::map<std::string, std::string> m_files;
};

TEST_F(ReportDiff, OfTheSameReportIsEmpty) {
    const json same = diff();
    EXPECT_EQ(same["differences"], json::array());
    EXPECT_EQ(same["summary"]["pictures"], json({{"identical", 4}, {"different", 0}, {"not examined", 0}}));
    EXPECT_EQ(same["summary"]["times"], json({{"faster", 0}, {"slower", 0}, {"not resolved", 3}}));
    EXPECT_FALSE(is_worse(same));
}

TEST_F(ReportDiff, PicturesAreComparedWithEachOther) {
    Image8 changed(4, 2);
    changed.pixel(2, 1)[1] = 51;
    changed.pixel(1, 0)[0] = 3;
    result(b, 1)["images"]["color"] = image(changed);
    MapSink sink;
    const json whole = diff({.pictures = &sink});
    const json picture = whole["runs"][0]["results"][1]["picture"];
    EXPECT_EQ(picture["verdict"], "different");
    EXPECT_EQ(picture["differing_pixels"], 2);
    EXPECT_EQ(picture["greatest_levels"], 51);
    EXPECT_EQ(picture["worst_pixel"], json({2, 1}));
    EXPECT_GT(picture["flip"]["max"], picture["flip"]["mean"]);
    EXPECT_GT(picture["flip"]["mean"], 0);
    EXPECT_EQ(picture["flip_picture"]["url"], "there/001-2.flip.png");
    const Image8 map = decode_png(sink.bytes_by_name.at("001-2.flip.png"), 4, 2);
    EXPECT_NE(map.rgb, Image8(4, 2).rgb);
    EXPECT_EQ(sink.bytes_by_name.size(), 1u) << "identical pictures have no map";
    EXPECT_EQ(whole["runs"][0]["results"][0]["picture"]["verdict"], "identical");
    EXPECT_TRUE(is_worse(whole));
    EXPECT_THAT(diff_table(whole), HasSubstr("different"));
}

TEST_F(ReportDiff, DifferentBytesOfTheSamePixelsAreIdentical) {
    // An ancillary chunk before the end: an empty comment, CRC of "tEXt" and a zero.
    json& picture = result(b, 1)["images"]["color"];
    std::string png = m_files.at(picture["url"]);
    constexpr std::size_t end_chunk_bytes = 12;
    const std::string comment("\0\0\0\2tEXta\0", 10);
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 4; i < comment.size(); ++i) {
        crc ^= static_cast<unsigned char>(comment[i]);
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    crc = ~crc;
    std::string chunk = comment;
    for (int shift = 24; shift >= 0; shift -= 8) chunk += static_cast<char>(crc >> shift & 0xff);
    png.insert(png.size() - end_chunk_bytes, chunk);
    const std::string sha256 = sha256_hex(png);
    m_files[sha256] = png;
    picture["sha256"] = picture["url"] = sha256;
    EXPECT_EQ(of(1, "picture")["verdict"], "identical");
    EXPECT_EQ(of(1, "picture")["differing_pixels"], 0);
}

TEST_F(ReportDiff, AMethodIsSlowerIfItsTimeAndItsRatioSaySo) {
    result(b, 1)["timing"] = timing(13);
    const json time = of(1, "time");
    EXPECT_NEAR(time["absolute"]["value"].get<double>(), 1 / 1.3, 0.01);
    EXPECT_EQ(time["absolute"]["verdict"], "slower");
    EXPECT_NEAR(time["relative"]["value"].get<double>(), 1 / 1.3, 1e-9);
    EXPECT_EQ(time["verdict"], "slower");
    EXPECT_EQ(of(2, "time")["verdict"], "not resolved");
    EXPECT_TRUE(is_worse(diff()));
    std::swap(a, b);
    EXPECT_EQ(of(1, "time")["verdict"], "faster");
    EXPECT_FALSE(is_worse(diff())) << "faster is not worse";
}

/// FLIP of the picture is its own test; here only the limits count. All times grow by 13 / 10, so the whole interval of
/// the slowdown is 1.3.
TEST_F(ReportDiff, OnlyWhatIsBeyondTheToleranceIsWorse) {
    Image8 changed(4, 2);
    changed.pixel(2, 1)[1] = 51;
    result(b, 1)["images"]["color"] = image(changed);
    result(b, 1)["timing"] = timing(13);
    const json both = diff();
    const auto flip = both["runs"][0]["results"][1]["picture"]["flip"]["mean"].get<double>();
    const auto worse = [&](double max_flip, double max_slowdown) {
        return changes_for_the_worse(from_document<diff::Diff>(both),
                                     {.max_flip = max_flip, .max_slowdown = max_slowdown})
            .size();
    };
    EXPECT_EQ(worse(0, 1), 2u);
    EXPECT_EQ(worse(flip * 1.01, 1), 1u);
    EXPECT_EQ(worse(flip * 0.99, 2), 1u);
    EXPECT_EQ(worse(flip * 1.01, 1.4), 0u);
    EXPECT_EQ(worse(1, 1.2), 1u);
    result(b, 2)["status"] = "failed";
    EXPECT_FALSE(changes_for_the_worse(from_document<diff::Diff>(diff()), {.max_flip = 1, .max_slowdown = 9}).empty())
        << "no tolerance covers a method that no longer renders";
}

TEST_F(ReportDiff, AMethodWithItsOwnShadingIsAnother) {
    b["spec"]["methods"][1]["shading"] = {{"glsl", "return tint;"}};
    EXPECT_THAT(conflicts(), testing::ElementsAre("/spec/methods/1/shading"));
    EXPECT_THAT(conflicts({"/methods/1/shading"}), testing::IsEmpty());
}

TEST_F(ReportDiff, ASlowerMachineDoesNotMakeAMethodSlower) {
    for (std::size_t i = 0; i < 3; ++i) result(b, i)["timing"] = timing(15);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(of(i, "time")["absolute"]["verdict"], "slower");
        EXPECT_EQ(of(i, "time")["verdict"], "not resolved");
        EXPECT_FALSE(of(i, "time")["reason"].is_null());
    }
    EXPECT_FALSE(is_worse(diff()));
    // Between different devices only the time counts.
    b["device"]["cpu"] = "another";
    EXPECT_EQ(of(0, "time")["verdict"], "slower");
    EXPECT_EQ(diff()["same_device"], false);
}

TEST_F(ReportDiff, AFasterBaselineDoesNotMakeOtherMethodsSlower) {
    result(b, 0)["timing"] = timing(5);
    const json time = of(1, "time");
    EXPECT_EQ(time["relative"]["verdict"], "slower");
    EXPECT_EQ(time["verdict"], "not resolved");
    EXPECT_TRUE(of(0, "time")["relative"].is_null());
    EXPECT_THAT(of(0, "time")["relative_reason"].get<std::string>(), HasSubstr("baseline"));
}

TEST_F(ReportDiff, TheNoiseOfBothReportsCounts) {
    result(b, 1)["timing"] = timing(13);
    a["runs"][0]["noise_floor"]["factor"] = b["runs"][0]["noise_floor"]["factor"] = 1.15;
    EXPECT_EQ(of(1, "time")["reason"], "inside the noise floor") << "1.15 times 1.15 is over 1.3";
    b["runs"][0]["noise_floor"]["factor"] = nullptr;
    EXPECT_EQ(of(2, "time")["verdict"], "not resolved") << "null means infinite";
}

TEST_F(ReportDiff, IfClocksDifferTheWallClockIsUsed) {
    json& timing_b = result(b, 1)["timing"];
    timing_b["clock"] = "gpu";
    for (json& sample : timing_b["samples"]) sample = sample.get<double>() / 2;
    EXPECT_EQ(of(1, "time")["clock"], "wall");
    EXPECT_EQ(of(1, "time")["absolute"]["value"], 1.0);
}

TEST_F(ReportDiff, TimesOfZeroAreNotResolved) {
    for (json& sample : result(b, 1)["timing"]["samples"]) sample = 0;
    EXPECT_TRUE(of(1, "time")["absolute"].is_null());
    EXPECT_EQ(of(1, "time")["verdict"], "not resolved");
    EXPECT_NO_THROW(diff_table(diff()));
}

TEST_F(ReportDiff, AMethodThatNoLongerRunsIsWorse) {
    result(b, 2)["status"] = "failed";
    result(b, 2)["reason"] = "no <memory>";
    EXPECT_TRUE(of(2, "picture").is_null());
    EXPECT_EQ(of(2, "reason")["b"], "no <memory>");
    EXPECT_EQ(diff()["summary"]["statuses_changed"], 1);
    EXPECT_EQ(diff()["runs"][0]["compared"], 2);
    EXPECT_TRUE(is_worse(diff()));
    EXPECT_THAT(diff_table(diff()), HasSubstr("ok in A, failed in B"));
}

TEST_F(ReportDiff, DifferencesThatLeaveThePicturesAloneAreListed) {
    b["spec"]["timing"]["rounds"] = 20;
    b["spec"]["scene"]["newer"] = 1;
    b["provenance"]["commit"] = "def";
    b["provenance"]["rerun"] = "sheer compare b.json";
    b["device"]["vendor"] = "another";
    a["provenance"]["load"] = {{"start", {1, 2, 3}}, {"end", nullptr}};
    b["provenance"]["load"] = {{"start", {1, 3, 3}}, {"end", nullptr}};
    std::vector<std::string> pointers;
    const json differences = diff()["differences"];
    for (const json& one : differences) pointers.push_back(one["pointer"]);
    EXPECT_THAT(pointers, ElementsAre("/spec/scene/newer", "/spec/timing/rounds", "/device/vendor",
                                      "/provenance/commit", "/provenance/load/start"));
    EXPECT_EQ(differences[0], json({{"pointer", "/spec/scene/newer"}, {"a", nullptr}, {"b", 1}}));
    EXPECT_EQ(diff()["b"]["commit"], "def");
    // An older report does not mention it.
    b["provenance"]["cores"] = 2;
    EXPECT_EQ(diff()["differences"][4], json({{"pointer", "/provenance/cores"}, {"a", nullptr}, {"b", 2}}));
}

TEST_F(ReportDiff, AFileThatChangedIsNamed) {
    const auto file = [](const std::string& name, const std::string& sha256, int bytes) -> json {
        return {{"pointer", "/scene/model"}, {"name", name}, {"of", nullptr}, {"sha256", sha256}, {"bytes", bytes}};
    };
    a["files"] = {file("same.bin", "00", 1), file("glass.gltf", "aa", 10), file("old.bin", "cc", 3)};
    EXPECT_TRUE(diff()["differences"].empty()) << "older reports do not list their files";
    // In another order, since files are matched by name.
    b["files"] = {file("glass.gltf", "bb", 12), file("same.bin", "00", 1), file("new.bin", "dd", 4)};
    const json changed = diff();
    EXPECT_EQ(changed["differences"],
              json::array({{{"pointer", "/files/1"}, {"a", a["files"][1]}, {"b", b["files"][0]}},
                           {{"pointer", "/files/2"}, {"a", a["files"][2]}, {"b", nullptr}},
                           {{"pointer", "/files/2"}, {"a", nullptr}, {"b", b["files"][2]}}}));
    const std::string table = diff_table(changed);
    EXPECT_THAT(table, HasSubstr("The file glass.gltf (/scene/model): 10 bytes, SHA-256 aa | 12 bytes, SHA-256 bb\n"));
    EXPECT_THAT(table, HasSubstr("The file new.bin (/scene/model): - | 4 bytes, SHA-256 dd\n"));
    // The path of the spec is not a difference.
    a["provenance"]["spec"] = "/one/spec.json";
    b["provenance"]["spec"] = "/two/spec.json";
    EXPECT_EQ(diff()["differences"].size(), 3u);
}

TEST_F(ReportDiff, MethodsOfOnlyOneAreListed) {
    b["spec"]["methods"].erase(1);
    b["runs"][0]["results"].erase(1);
    const json less = diff();
    EXPECT_EQ(less["only_in"]["a"]["methods"], json({"f2b"}));
    EXPECT_EQ(less["only_in"]["b"]["methods"], json::array());
    EXPECT_EQ(less["runs"][0]["results"].size(), 2u);
    EXPECT_FALSE(is_worse(less));
}

TEST_F(ReportDiff, SpecsOfDifferentPicturesAreRefusedByPointer) {
    b["spec"]["image"]["width"] = 8;
    b["spec"]["scene"]["count"] = 4;
    b["spec"]["methods"][2]["id"] = "f2bx";
    EXPECT_THAT(conflicts(), ElementsAre("/spec/methods/2/id", "/spec/image/width", "/spec/scene/count"));
}

TEST_F(ReportDiff, AllowedDifferencesAreComparedAndStayListed) {
    a["spec"]["scene"]["shading"] = {{"glsl", "one"}};
    b["spec"]["scene"]["shading"] = {{"glsl", "two"}};
    b["spec"]["timing"]["rounds"] = 20;
    Image8 changed(4, 2);
    changed.pixel(0, 0)[0] = 9;
    result(b, 1)["images"]["color"] = image(changed);
    EXPECT_THAT(conflicts(), ElementsAre("/spec/scene/shading/glsl"));
    EXPECT_THAT(offered(), ElementsAre("/scene/shading/glsl"));
    // The field itself, the object that contains it, and the whole spec.
    for (const char* pointer : {"/scene/shading/glsl", "/scene/shading", "/scene", ""}) {
        const json allowed = diff({.allow = {pointer}});
        EXPECT_EQ(allowed["differences"],
                  json::array({{{"pointer", "/spec/scene/shading/glsl"}, {"a", "one"}, {"b", "two"}, {"allowed", true}},
                               {{"pointer", "/spec/timing/rounds"}, {"a", 6}, {"b", 20}}}))
            << pointer;
        EXPECT_EQ(allowed["summary"]["pictures"], json({{"identical", 3}, {"different", 1}, {"not examined", 0}}));
        EXPECT_TRUE(is_worse(allowed)) << "a changed picture is reported, whatever made it change";
        EXPECT_THAT(diff_table(allowed), HasSubstr("/spec/scene/shading/glsl (allowed): one | two\n"));
    }
    // Neither something below the field nor a pointer that only begins in the same way.
    for (const char* pointer : {"/scene/shading/glsl/0", "/scene/shading/gl", "/scene/shad", "/spec/scene", "/"})
        EXPECT_THAT(conflicts({pointer}), ElementsAre("/spec/scene/shading/glsl")) << pointer;
}

TEST_F(ReportDiff, AMethodsFieldIsAllowedByItsPlaceInTheFirstReport) {
    a["spec"]["methods"][2]["threshold"] = 0.02;
    b["spec"]["methods"][2]["threshold"] = 0.05;
    std::swap(b["spec"]["methods"][1], b["spec"]["methods"][2]);
    EXPECT_THAT(offered(), ElementsAre("/methods/2/threshold"));
    EXPECT_THAT(conflicts({"/methods/1"}), ElementsAre("/spec/methods/2/threshold"));
    EXPECT_THAT(conflicts({"/methods/2/threshold"}), ElementsAre());
}

TEST_F(ReportDiff, OnlyFieldsThatAreNotAllowedAreRefused) {
    b["spec"]["scene"]["count"] = 4;
    b["spec"]["methods"][2]["id"] = "f2bx";
    a["spec"]["image"]["format"] = "rgba8";
    b["spec"]["image"]["format"] = "rgba16f";
    EXPECT_THAT(offered({"/scene"}), ElementsAre("/methods/2/id", "/image/format"));
    EXPECT_THAT(conflicts({"/scene", "/methods/2", "/image/format"}), ElementsAre());
}

TEST_F(ReportDiff, ManyFieldsAreOfferedAsTheirPartsOfTheSpec) {
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) {
        a["spec"]["scene"][name] = 1;
        b["spec"]["scene"][name] = 2;
    }
    b["spec"]["methods"][2]["id"] = "f2bx";
    EXPECT_EQ(offered().size(), 8u);
    b["spec"]["scene"]["count"] = 4;
    EXPECT_THAT(offered(), ElementsAre("/methods", "/scene"));
    EXPECT_THAT(conflicts(offered()), ElementsAre());
}

TEST_F(ReportDiff, SizesAreRefusedEvenIfAllowed) {
    b["spec"]["image"]["height"] = 4;
    b["spec"]["scene"]["count"] = 4;
    for (const std::vector<std::string>& allow : {std::vector<std::string>{"/image/height"}, {"/image"}, {""}}) {
        EXPECT_EQ(conflicts(allow).front(), "/spec/image/height");
        EXPECT_THAT(offered(allow), ElementsAre()) << "allowing would not help";
    }
    EXPECT_THAT(conflicts({"/image", "/scene"}), ElementsAre("/spec/image/height"));
    try {
        diff({.allow = {""}});
        ADD_FAILURE() << "it was not refused";
    } catch (const SpecError& refused) {
        EXPECT_THAT(refused.what(), HasSubstr("is 2 in one report and 4 in the other; pictures of different sizes"));
    }
}

TEST_F(ReportDiff, InvalidPointersAreRefusedByTheirText) {
    try {
        diff({.allow = {"/scene", "scene/count", "/scene/~2"}});
        ADD_FAILURE() << "it was not refused";
    } catch (const SpecError& wrong) {
        ASSERT_EQ(wrong.errors().size(), 2u);
        EXPECT_EQ(wrong.errors()[0].pointer, "/allow");
        EXPECT_THAT(wrong.errors()[0].detail, HasSubstr("\"scene/count\" is not a JSON pointer"));
        EXPECT_THAT(wrong.errors()[1].detail, HasSubstr("\"/scene/~2\" is not a JSON pointer"));
    }
}

TEST_F(ReportDiff, PointsAreMatched) {
    a["runs"].push_back(a["runs"][0]);
    b["runs"].push_back(b["runs"][0]);
    a["runs"][0]["point"] = {{"/scene/count", 1}};
    a["runs"][1]["point"] = b["runs"][0]["point"] = {{"/scene/count", 2}};
    b["runs"][1]["point"] = {{"/scene/count", 3}};
    const json matched = diff();
    ASSERT_EQ(matched["runs"].size(), 1u);
    EXPECT_EQ(matched["runs"][0]["point"], json({{"/scene/count", 2}}));
    EXPECT_EQ(matched["only_in"]["a"]["points"], json({{{"/scene/count", 1}}}));
    EXPECT_EQ(matched["only_in"]["b"]["points"], json({{{"/scene/count", 3}}}));
    EXPECT_NO_THROW(diff({.run = 0}));
    EXPECT_THROW(diff({.run = 1}), SpecError);
    b["runs"].erase(0);
    EXPECT_THAT(conflicts(), ElementsAre("/spec/sweep"));
}

TEST_F(ReportDiff, ASweepOfMethodsNeedsThemInTheSameOrder) {
    a["runs"][0]["point"] = b["runs"][0]["point"] = {{"/methods/2/threshold", 0.5}};
    EXPECT_THAT(conflicts(), ElementsAre());
    std::swap(b["spec"]["methods"][1], b["spec"]["methods"][2]);
    EXPECT_THAT(conflicts(), ElementsAre("/spec/methods"));
    EXPECT_THAT(conflicts({""}), ElementsAre("/spec/methods"));
    EXPECT_THAT(offered(), ElementsAre());
}

TEST_F(ReportDiff, AReportMustBeDone) {
    b["status"] = "running";
    EXPECT_THAT(conflicts(), ElementsAre("/status"));
}

TEST_F(ReportDiff, PixelsBeyondTheLimitAreNotExamined) {
    Image8 changed(4, 2);
    changed.pixel(0, 0)[0] = 1;
    for (std::size_t i = 1; i < 3; ++i) result(b, i)["images"]["color"] = image(changed);
    const json limited = diff({.max_pixels = 8});
    EXPECT_EQ(limited["summary"]["pictures"], json({{"identical", 2}, {"different", 1}, {"not examined", 1}}));
    EXPECT_THAT(diff_table(limited), HasSubstr("too large in total"));
}

TEST_F(ReportDiff, PicturesThatDoNotMatchTheReportAreRefused) {
    const json color = image(Image8(5, 2));
    result(b, 1)["images"]["color"] = color;
    EXPECT_THROW(diff(), std::runtime_error) << "a different size";
    m_files[color["url"]] = "not a PNG file";
    EXPECT_THROW(diff(), std::runtime_error) << "a different hash";
    const std::string text = "not a PNG file, but with the right hash";
    m_files[sha256_hex(text)] = text;
    result(b, 1)["images"]["color"] = {{"sha256", sha256_hex(text)}, {"url", sha256_hex(text)}};
    EXPECT_THROW(diff(), std::runtime_error) << "not a PNG file";
}

TEST_F(ReportDiff, LinearPicturesAreComparedByTheirBytes) {
    EXPECT_TRUE(of(1, "picture")["linear"].is_null());
    result(a, 1)["images"]["linear"] = {{"sha256", "1"}};
    result(b, 1)["images"]["linear"] = {{"sha256", "2"}};
    EXPECT_EQ(of(1, "picture")["linear"], "different");
    EXPECT_EQ(of(1, "picture")["verdict"], "identical");
    EXPECT_FALSE(is_worse(diff()));
}

TEST_F(ReportDiff, MatchesItsDescription) {
    Image8 changed(4, 2);
    changed.pixel(0, 0)[0] = 9;
    // Of two changed pictures only the first, the reference's, is examined.
    b["runs"][0]["reference"]["images"]["color"] = image(changed);
    result(b, 1)["images"]["color"] = image(changed);
    result(b, 2)["status"] = "failed";
    b["spec"]["scene"]["count"] = 4;
    MapSink sink;
    const json all = diff({.pictures = &sink, .max_pixels = 8, .allow = {"/scene"}});
    SchemaWalk walk = SchemaWalk::of<diff::Diff>();
    walk.check(all);
    EXPECT_THAT(walk.missing(), ElementsAre("Picture.full_scale", "Picture.greatest"));
    EXPECT_EQ(to_document(from_document<diff::Diff>(all)), all);
    EXPECT_TRUE(all["runs"][0]["results"][0]["picture"]["worst_pixel"].is_null()) << "there is no differing pixel";
    EXPECT_FALSE(all["runs"][0]["results"][1]["picture"].contains("worst_pixel")) << "unknown";
}

}  // namespace
}  // namespace sheer::report_diff_test
