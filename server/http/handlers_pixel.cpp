#include <fmt/format.h>

#include <memory>

#include "renderer/spec/sweep.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/slot.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr int max_pixels_at_a_time = 1;
// Beyond any image and any sweep: which ones there are depends on the report.
constexpr double max_coordinate_px = 1e6;

ReportRecord done_report_of(Service& service, const Request& request) {
    ReportRecord record = found_report(service.store, request);
    if (record.status != Status::done)
        throw Problem(409, fmt::format("The report is not done: it is {}.", status_text(record.status)));
    return record;
}

/// Throws Problem (422) that names the parameters that are outside the report.
void check_place(const PixelPlace& place, const json& report) {
    const json& runs = report.at("runs");
    std::vector<FieldError> errors;
    const auto check = [&errors](const char* parameter, int value, std::size_t count) {
        if (static_cast<std::size_t>(value) >= count)
            errors.push_back({parameter, fmt::format("must be in 0 to {}", count - 1)});
    };
    check("/run", place.run, runs.size());
    if (errors.empty()) {
        const json image = at_point(report.at("spec"), runs[static_cast<std::size_t>(place.run)].at("point"))["image"];
        check("/x", place.x, image.at("width"));
        check("/y", place.y, image.at("height"));
    }
    if (!errors.empty()) throw Problem(422, "The report has no such pixel.", errors);
}

Answer get_pixel(Service& service, std::atomic<int>& taken, const Request& request) {
    const PixelPlace place{request.query["x"], request.query["y"], request.query["run"]};
    const ReportRecord record = done_report_of(service, request);
    check_place(place, json::parse(record.report));
    const Slot slot(taken, max_pixels_at_a_time, "Another pixel is being taken apart; come again.");
    const PixelAnswer answer = service.take_pixel_apart(record.report, place);
    if (answer.too_slow) throw Problem(503, answer.refusal);
    if (!answer.refusal.empty()) throw Problem(409, answer.refusal);
    return text_response(200, answer.json, "application/json");
}

}  // namespace

std::vector<Route> pixel_routes(Service& service) {
    const auto coordinate = [](const char* name, const char* summary) {
        return Param::integer(name, summary, "px", 0, 0, max_coordinate_px).required();
    };
    auto taken = std::make_shared<std::atomic<int>>(0);
    return {{.method = "GET",
             .pattern = std::string(reports_path) + "/{id}/pixel",
             .id = "getReportPixel",
             .summary = "Every fragment under a pixel of a done report, and what each method made of them",
             .query = {coordinate("x", "column of the pixel, from the left"),
                       coordinate("y", "row of the pixel, from the top"),
                       Param::integer("run", "which run of the report, so which point of the sweep", "", 0, 0,
                                      max_sweep_points)},
             .replies = {{200, "The pixel", "application/json", "Pixel"},
                         {404, "There is no such report", "application/problem+json", "Problem"},
                         {409, "The report is not done, or can no longer be rendered", "application/problem+json",
                          "Problem"},
                         {422, "A parameter is missing, no number, or outside the report; `errors` names it",
                          "application/problem+json", "Problem"},
                         {429, "Another pixel is being taken apart; Retry-After says when to come again",
                          "application/problem+json", "Problem"},
                         {503, "It takes too long", "application/problem+json", "Problem"}},
             .handle = [&service, taken](const Request& request) { return get_pixel(service, *taken, request); },
             .wrong_query_status = 422}};
}

}  // namespace sheer::http
