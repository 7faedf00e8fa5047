#include <fmt/format.h>

#include <memory>

#include "renderer/files/report_document.h"
#include "renderer/spec/sweep.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/slot.h"

namespace sheer::http {

namespace {

constexpr int max_pixels_at_a_time = 1;
// Greater than any image and any sweep: the actual limits depend on the report.
constexpr double max_coordinate_px = 1e6;

ReportRecord done_report_of(Service& service, const Request& request) {
    ReportRecord record = found_report(service.store, request);
    if (record.status != Status::done)
        throw Problem(409, fmt::format("The report is not done: it is {}.", status_text(record.status)));
    return record;
}

/// Throws Problem (422) naming the parameters that are outside the report.
void check_place(const PixelPlace& place, const report::Report& report) {
    std::vector<FieldError> errors;
    const auto check = [&errors](const char* parameter, int value, std::size_t count) {
        if (static_cast<std::size_t>(value) >= count)
            errors.push_back({parameter, fmt::format("must be from 0 to {}", count - 1)});
    };
    check("/run", place.run, report.runs.size());
    if (errors.empty()) {
        const auto [width_px, height_px] =
            picture_size_px(report, report.runs[static_cast<std::size_t>(place.run)].point);
        check("/x", place.x, static_cast<std::size_t>(width_px));
        check("/y", place.y, static_cast<std::size_t>(height_px));
    }
    if (!errors.empty()) throw Problem(422, "The report has no such pixel.", errors);
}

Answer get_pixel(Service& service, std::atomic<int>& taken, const Request& request) {
    const PixelPlace place{request.query["x"], request.query["y"], request.query["run"]};
    const ReportRecord record = done_report_of(service, request);
    use_stored(record.id, [&] { check_place(place, report_of(record)); });
    const Slot slot(taken, max_pixels_at_a_time, "Another pixel is being explained; try again later.");
    const PixelAnswer answer = service.pixel(record.report, place);
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
             .summary = "Every fragment under a pixel of a done report, and each method's result",
             .query = {coordinate("x", "column of the pixel from the left"),
                       coordinate("y", "row of the pixel from the top"),
                       Param::integer("run", "the run of the report, that is, the point of the sweep", "", 0, 0,
                                      max_sweep_points)},
             .replies = {{200, "The pixel", "application/json", "Pixel"},
                         {404, "There is no such report", "application/problem+json", "Problem"},
                         {409, "The report is not done, or can no longer be rendered", "application/problem+json",
                          "Problem"},
                         {422, "A parameter is missing, not a number, or outside the report; `errors` names it",
                          "application/problem+json", "Problem"},
                         {429, "Another pixel is being explained; Retry-After says when to try again",
                          "application/problem+json", "Problem"},
                         {503, "It takes too long", "application/problem+json", "Problem"}},
             .handle = [&service, taken](const Request& request) { return get_pixel(service, *taken, request); },
             .wrong_query_status = 422}};
}

}  // namespace sheer::http
