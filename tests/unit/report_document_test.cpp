#include "renderer/files/report_document.h"

#include <gtest/gtest.h>

namespace sheer::report_document_test {
namespace {

using nlohmann::json;

/// The members that every version of a report has had.
json smallest_report() {
    json results = json::array();
    for (const char* id : {"b2f", "f2b"})
        results.push_back({{"method", id},
                           {"label", id},
                           {"status", "ok"},
                           {"images", json::object()},
                           {"timing", {{"samples", {1, 2, 3}}}}});
    const json run = {{"point", json::object()},
                      {"reference", {{"method", "exact"}, {"images", json::object()}}},
                      {"results", results}};
    return {{"status", "done"},
            {"created_at", "2026-01-01T00:00:00.000Z"},
            {"spec", {{"image", {{"width", 4}, {"height", 2}}}, {"methods", {{{"label", "b2f"}}, {{"label", "f2b"}}}}}},
            {"runs", {run}}};
}

TEST(ReportDocument, SizesOfPicturesAreThoseOfThePoint) {
    json document = smallest_report();
    document["runs"][0]["point"] = {{"/image/width", 6}};
    const report::Report report = read_report(document);
    EXPECT_EQ(picture_size_px(report, report.runs[0].point), (std::array{6, 2}));
    EXPECT_EQ(picture_size_px(report, json::object()), (std::array{4, 2}));
}

TEST(ReportDocument, OtherDocumentsAreRefusedByPointer) {
    const json whole = smallest_report();
    const auto refusal = [&](const json::json_pointer& place, const json& value) -> std::string {
        json report = whole;
        if (value.is_null()) {
            json& parent = report[place.parent_pointer()];
            parent.erase(place.back());
        } else {
            report[place] = value;
        }
        try {
            read_report(report);
        } catch (const DocumentError& wrong) {
            return wrong.what();
        }
        return "";
    };
    EXPECT_EQ(refusal("/runs"_json_pointer, nullptr), "/runs is missing");
    EXPECT_EQ(refusal("/runs/0/results"_json_pointer, nullptr), "/runs/0/results is missing");
    EXPECT_EQ(refusal("/runs/0/results/1/label"_json_pointer, nullptr), "/runs/0/results/1/label is missing");
    EXPECT_EQ(refusal("/runs/0/results/1/status"_json_pointer, "good"),
              "/runs/0/results/1/status has the unknown value \"good\"");
    EXPECT_EQ(refusal("/runs/0/results/1/timing/samples/2"_json_pointer, "1"),
              "/runs/0/results/1/timing/samples/2 must be a number, not \"1\"");
    EXPECT_EQ(refusal("/runs/0/reference/images"_json_pointer, nullptr), "/runs/0/reference/images is missing");
    EXPECT_EQ(refusal("/runs/0/point"_json_pointer, 3), "/runs/0/point must be an object");
    EXPECT_EQ(refusal("/runs/0/point"_json_pointer, {{"scene", 3}}),
              "/spec does not have the fields that the sweep sets");
    EXPECT_EQ(refusal("/spec"_json_pointer, "all"), "/spec must be an object");
    EXPECT_EQ(refusal("/spec/methods/0"_json_pointer, "b2f"), "/spec/methods/0 must be an object");
    EXPECT_EQ(refusal("/spec/methods/0/label"_json_pointer, 1), "/spec/methods/0/label must be a string");
    EXPECT_EQ(refusal("/spec/image/height"_json_pointer, nullptr), "/spec/image/height must be a whole number");
    EXPECT_EQ(refusal("/spec/title"_json_pointer, 5), "/spec/title must be a string");
    EXPECT_EQ(refusal("/files"_json_pointer, 5), "/files must be an array, not 5");
    EXPECT_EQ(refusal("/created_at"_json_pointer, nullptr), "") << "an older report may lack the rest";
}

}  // namespace
}  // namespace sheer::report_document_test
