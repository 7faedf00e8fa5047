#include <fmt/format.h>

#include <atomic>
#include <memory>

#include "renderer/files/report_document.h"
#include "renderer/spec/sweep.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/slot.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

constexpr std::size_t max_id_bytes = 200, max_allow_bytes = 4000;
std::vector<std::string> allowed_pointers(const std::string& text) {
    std::vector<std::string> pointers;
    if (text.empty()) return pointers;
    for (const std::string_view pointer : split(text, ',')) pointers.emplace_back(pointer);
    return pointers;
}

Problem problem_of(const DiffAnswer& refused) {
    const std::string refusal = "The reports cannot be compared with each other";
    if (refused.allowable.empty()) return {422, refusal + ".", refused.errors};
    return Problem(
               422,
               fmt::format("{}; to compare them nevertheless, allow {}", refusal, fmt::join(refused.allowable, ", ")),
               refused.errors)
        .with_allowable(refused.allowable);
}

nlohmann::json comparable_report(Store& store, const std::string& id) {
    const report::Report report = done_report(store, id);
    use_stored(id, [&] { check_comparable(report); });
    return to_document(report);
}

Answer get_diff(Service& service, std::atomic<int>& diffs, const Request& request) {
    const nlohmann::json a = comparable_report(service.store, request.path_values.at("id"));
    const nlohmann::json b = comparable_report(service.store, request.query["against"]);
    DiffQuestion question{.a = a, .b = b, .run = {}, .allow = allowed_pointers(request.query["allow"])};
    if (request.query["run"].is_number()) question.run = request.query["run"].get<std::size_t>();
    const Slot slot(diffs, service.limits.max_diffs, "Other reports are being compared; try again later.");
    const DiffAnswer answer = service.diff(question);
    if (answer.too_slow) throw Problem(503, answer.detail);
    if (answer.json.empty()) throw problem_of(answer);
    return text_response(200, answer.json, "application/json");
}

}  // namespace

std::vector<Route> diff_routes(Service& service) {
    auto diffs = std::make_shared<std::atomic<int>>(0);
    Param run = Param::integer("run", "only this one of the common runs, with its FLIP maps as data: URIs", "", 0, 0,
                               static_cast<double>(max_sweep_points) - 1);
    run.default_value = nullptr;
    run.optional = true;
    return {{.method = "GET",
             .pattern = std::string(reports_path) + "/{id}/diff",
             .id = "diffReports",
             .summary = "What changed between two done reports of the same spec, in pictures and in time",
             .description =
                 "Pictures are compared pixel by pixel, times by their intervals, after a correction for the machine's "
                 "own change of speed.",
             .query = {Param::text("against", "id of the later report", "", max_id_bytes).required(), std::move(run),
                       Param::text("allow",
                                   "JSON pointers into the spec, separated by commas, such as /scene/shading/glsl: the "
                                   "fields there and below may differ",
                                   "", max_allow_bytes)},
             .replies = {{200, "What changed", "application/json", "Diff"},
                         {404, "There is no such report", "application/problem+json", "Problem"},
                         {409, "A report is not done", "application/problem+json", "Problem"},
                         {422, "The reports have different specs; `errors` names the fields, `allow` what to allow",
                          "application/problem+json", "Problem"},
                         {429,
                          "Other reports are being compared; Retry-After says when to try again",
                          "application/problem+json",
                          "Problem",
                          {"Retry-After"}},
                         {503, "It takes too long", "application/problem+json", "Problem"}},
             .handle = [&service, diffs](const Request& request) { return get_diff(service, *diffs, request); }}};
}

}  // namespace sheer::http
