// The parts of a report of several devices, joined: its runs, verdict, checks, and the table across devices.
#include "renderer/diff/join.h"

#include <gmock/gmock.h>

#include <map>

#include "renderer/core/errors.h"
#include "renderer/core/sha256.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/pictures/picture_file.h"
#include "renderer/report/across_table.h"
#include "renderer/report/markdown.h"
#include "renderer/report/report.h"
#include "renderer/spec/spec.h"

namespace sheer::join_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// The mean FLIP error of a black pixel beside one that is brighter by `level`, by the metric itself.
double flip_of(int level) {
    Image black(4, 2), other(4, 2);
    for (std::size_t i = 0; i < black.pixel_count(); ++i) {
        black.rgba[i * 4 + 3] = other.rgba[i * 4 + 3] = 1;
        other.rgba[i * 4] = static_cast<float>(level) / 255;
    }
    const auto flip = std::ranges::find(all_metrics(), "flip", &MetricInfo::id);
    return flip->compute(ImagePair(black, other)).value["mean"];
}

class Join : public testing::Test {
  protected:
    json m_spec = parse_spec({{"image", {{"width", 4}, {"height", 2}}},
                              {"scene", {{"type", "quads"}}},
                              {"methods", {"b2f", "f2b"}},
                              {"device", {"gpu", "cpu"}},
                              {"checks",
                               {{{"metric", "rmse"}, {"method", "f2b"}, {"max", 1}},
                                {{"metric", "rmse"}, {"method", "b2f"}, {"max", 1}, {"at", {{"/device", "cpu"}}}}}}})
                      .normalised;
    std::map<std::string, std::string> m_files;

    report::Picture picture(int level) {
        Image8 pixels(4, 2);
        for (std::size_t i = 0; i < pixels.rgb.size(); i += 3) pixels.rgb[i] = static_cast<std::uint8_t>(level);
        const std::string png = encode_png(pixels), sha256 = sha256_hex(png);
        m_files[sha256] = png;
        report::Picture named;
        named.sha256 = sha256;
        named.url = sha256;
        named.media_type = "image/png";
        return named;
    }

    /// A part whose methods' pictures have these levels of red.
    RenderedPart part(const std::string& label, double median, std::vector<int> levels) {
        report::Report report;
        report.spec = spec_of_device(m_spec, label);
        report.device.emplace().renderer = "renderer of " + label;
        report.points = {1, 1};
        report.notes = {{"code", "the same on each", ""}};
        report::Run& run = report.runs.emplace_back();
        for (std::size_t i = 0; i < levels.size(); ++i) {
            report::Result& result = run.results.emplace_back();
            result.method = result.label = i == 0 ? "b2f" : "f2b";
            result.images["color"] = picture(levels[i]);
            result.timing.emplace().median = median;
            result.timing->ci95 = report::Interval{median - 1, median + 1};
        }
        for (const json& check : report.spec["checks"]) {
            report::Check passed{.metric = "rmse", .method = check["method"], .max = 1};
            passed.outcome = report::CheckOutcome::passed;
            passed.passed = true;
            report.checks.push_back(passed);
        }
        return {.label = label, .report = report, .reason = ""};
    }

    report::Report join(const std::vector<RenderedPart>& parts) {
        return join_parts(m_spec, parts, [this](const report::Picture& one) { return m_files.at(one.sha256); });
    }
};

TEST_F(Join, HasARunForEachDeviceAndComparesTheirPictures) {
    const report::Report report = join({part("gpu", 2, {0, 0}), part("cpu", 20, {0, 90})});
    ASSERT_EQ(report.runs.size(), 2u);
    EXPECT_EQ(report.runs[0].point, json({{"/device", "gpu"}}));
    EXPECT_EQ(report.runs[1].point, json({{"/device", "cpu"}}));
    EXPECT_EQ(report.devices[0].device->renderer, "renderer of gpu");
    EXPECT_EQ(report.devices[1].device->renderer, "renderer of cpu");
    EXPECT_EQ(report.device->renderer, "renderer of gpu");
    EXPECT_EQ(report.points.asked, 2u);
    EXPECT_EQ(report.points.done, 2u);
    EXPECT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.spec["device"], json({"gpu", "cpu"}));
    ASSERT_EQ(report.across_devices.size(), 2u);
    const report::AcrossRow &same = report.across_devices[0], &other = report.across_devices[1];
    EXPECT_EQ(same.method, "b2f");
    EXPECT_EQ(same.at, json::object());
    EXPECT_DOUBLE_EQ(*same.devices[0].median, 2);
    EXPECT_DOUBLE_EQ(*same.devices[1].median, 20);
    EXPECT_FALSE(same.devices[0].flip);
    EXPECT_EQ(*same.devices[1].flip, 0);
    EXPECT_EQ(same.devices[1].differing_pixels, 0u);
    EXPECT_GT(flip_of(90), 0.05);
    EXPECT_NEAR(*other.devices[1].flip, flip_of(90), 1e-6);
    EXPECT_EQ(other.devices[1].differing_pixels, 8u);
    EXPECT_EQ(report.verdict, report::ReportVerdict::passed);
    std::vector<std::string> checks;
    for (const report::Check& check : report.checks) checks.push_back(check.method + " " + check.at.dump());
    EXPECT_THAT(checks,
                ElementsAre(R"(f2b {"/device":"gpu"})", R"(f2b {"/device":"cpu"})", R"(b2f {"/device":"cpu"})"));
}

TEST_F(Join, ADeviceThatFailedHasRunsWithTheReason) {
    const report::Report report =
        join({part("gpu", 2, {0, 0}), {.label = "cpu", .report = {}, .reason = "The renderer died (signal 11)."}});
    ASSERT_EQ(report.runs.size(), 2u);
    const report::Run& failed = report.runs[1];
    EXPECT_EQ(failed.point, json({{"/device", "cpu"}}));
    EXPECT_EQ(failed.reference.status, report::ResultStatus::failed);
    for (const report::Result& result : failed.results) {
        EXPECT_EQ(result.status, report::ResultStatus::failed);
        EXPECT_EQ(result.reason, "The renderer died (signal 11).");
    }
    EXPECT_EQ(report.devices[1].status, report::Status::failed);
    EXPECT_EQ(report.verdict, report::ReportVerdict::failed);
    EXPECT_EQ(report.verdict_reason, "2 of 3 checks failed; the device cpu failed: The renderer died (signal 11).");
    EXPECT_FALSE(report.across_devices[0].devices[1].flip);
    EXPECT_EQ(report.across_devices[0].devices[1].flip.reason, "The renderer died (signal 11).");
    EXPECT_EQ(report.points.done, 1u);
}

TEST_F(Join, WithoutTheFirstDeviceNothingIsCompared) {
    const report::Report report = join({{.label = "gpu", .report = {}, .reason = "no GPU"}, part("cpu", 20, {0, 90})});
    EXPECT_EQ(report.device->renderer, "renderer of cpu");
    EXPECT_EQ(report.across_devices[1].devices[1].flip.reason, "no picture on gpu: no GPU");
    EXPECT_DOUBLE_EQ(*report.across_devices[1].devices[1].median, 20);
    EXPECT_THROW(join({{.label = "gpu", .report = {}, .reason = "x"}, {.label = "cpu", .report = {}, .reason = "x"}}),
                 std::invalid_argument);
}

TEST_F(Join, TheTablesHaveColumnsForEachDevice) {
    const report::Report report = join({part("gpu", 2, {0, 0}), part("cpu", 20, {0, 0})});
    EXPECT_EQ(across_table(report),
              "\nmethod  gpu ms [95 %]  cpu ms [95 %]    FLIP\n"
              "b2f          2 [1, 3]    20 [19, 21]  0.0000\n"
              "f2b          2 [1, 3]    20 [19, 21]  0.0000\n"
              "FLIP: mean error of the picture beside that of gpu.\n");
    EXPECT_THAT(report_markdown(report),
                HasSubstr("| method | gpu ms &#91;95 %&#93; | cpu ms &#91;95 %&#93; | FLIP |\n|---|--:|--:|--:|\n"
                          "| b2f | 2 &#91;1, 3&#93; | 20 &#91;19, 21&#93; | 0.0000 |"));
    EXPECT_THAT(report_table(report), HasSubstr("gpu: renderer of gpu, OpenGL"));
    EXPECT_THAT(report_junit(report), HasSubstr(R"(name="device.cpu" value="renderer of cpu")"));
    EXPECT_EQ(across_table(report::Report{}), "");
}

TEST(SpecOfDevices, IsAListOfDifferentLabels) {
    const json base = {{"scene", {{"type", "quads"}}}, {"methods", {"b2f"}}};
    const auto wrong = [&](const json& device, const json& more = json::object()) {
        json document = base;
        document.update(more);
        document["device"] = device;
        std::vector<std::string> pointers;
        try {
            parse_spec(document);
        } catch (const SpecError& error) {
            for (const FieldError& field : error.errors()) pointers.push_back(field.pointer);
        }
        return pointers;
    };
    EXPECT_THAT(wrong({"a", "b"}), testing::IsEmpty());
    EXPECT_THAT(wrong(json::array()), ElementsAre("/device"));
    EXPECT_THAT(wrong({"a", "b", "c", "d", "e", "f", "g", "h"}), testing::IsEmpty());
    EXPECT_THAT(wrong({"a", "b", "c", "d", "e", "f", "g", "h", "i"}), ElementsAre("/device"));
    EXPECT_THAT(wrong({"a", "b", "a"}), ElementsAre("/device/2"));
    EXPECT_THAT(wrong({"a", ""}), ElementsAre("/device/1"));
    EXPECT_THAT(wrong({"a", 1, std::string(201, 'x')}), ElementsAre("/device/1", "/device/2"));
    EXPECT_THAT(wrong(7), ElementsAre("/device"));
    EXPECT_THAT(wrong(std::string(201, 'x')), ElementsAre("/device"));
    EXPECT_THAT(wrong({"a", "b"}, {{"against", "baseline:main"}}), ElementsAre("/device"));
    const json sweep = {{{"pointer", "/scene/seed"}, {"values", std::vector<int>(129, 1)}}};
    EXPECT_THAT(wrong({"a", "b"}, {{"sweep", sweep}}), ElementsAre("/device"));
    EXPECT_THAT(wrong({"a", "b"},
                      {{"checks", {{{"metric", "rmse"}, {"method", "b2f"}, {"max", 1}, {"at", {{"/device", "c"}}}}}}}),
                ElementsAre("/checks/0/at"));
}

TEST(SpecOfDevices, OneLabelIsOneDevice) {
    const json base = {{"scene", {{"type", "quads"}}}, {"methods", {"b2f"}}, {"device", "a"}};
    json list = base;
    list["device"] = {"a"};
    EXPECT_EQ(parse_spec(list).canonical_text(), parse_spec(base).canonical_text());
    EXPECT_TRUE(parse_spec(list).devices.empty());
}

TEST(SpecOfDevices, EveryDeviceHasEveryPoint) {
    const Spec spec = parse_spec({{"scene", {{"type", "quads"}}},
                                  {"methods", {"b2f"}},
                                  {"device", {"b", "a"}},
                                  {"sweep", {{{"pointer", "/scene/count"}, {"values", {1, 16}}}}}});
    std::vector<std::string> points;
    for (const SweepPoint& point : spec.points) points.push_back(describe_point(point));
    EXPECT_THAT(points,
                ElementsAre("device b, count 1", "device b, count 16", "device a, count 1", "device a, count 16"));
    EXPECT_EQ(spec_at(spec, spec.points[3]).normalised["device"], "a");
    EXPECT_EQ(parse_spec(spec_of_device(spec.normalised, "a")).points.size(), 2u);
    EXPECT_EQ(parse_spec(spec.normalised).canonical_text(), spec.canonical_text());
}

}  // namespace
}  // namespace sheer::join_test
