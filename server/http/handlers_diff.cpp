#include <fmt/format.h>

#include <atomic>
#include <memory>

#include "renderer/files/data_uri.h"
#include "renderer/files/diff.h"
#include "renderer/spec/sweep.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/slot.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr std::size_t max_id_bytes = 200;
// Of pictures that a request may decode: some ten seconds of work.
constexpr std::uint64_t max_pixels = 64'000'000;

/// Pictures of a diff are in its text: nobody would collect them from the archive.
class InlineSink : public BlobSink {
    std::string put(const std::string&, const std::string& bytes, const std::string&,
                    const std::string& media_type) override {
        return data_uri(media_type, bytes);
    }
};

Answer get_diff(Service& service, std::atomic<int>& diffs, const Request& request) {
    const json a = done_report_json(service.store, request.path_values.at("id"));
    const json b = done_report_json(service.store, request.query["against"]);
    const auto read_picture = [&service](const json& image) { return picture_bytes(service.store, image); };
    InlineSink sink;
    DiffOptions options{.max_pixels = max_pixels};
    if (request.query["run"].is_number()) {
        options.run = request.query["run"].get<std::size_t>();
        options.pictures = &sink;
    }
    const Slot slot(diffs, service.max_diffs, "Other reports are being compared; come again.");
    try {
        return json_response(200, diff_reports({a, read_picture}, {b, read_picture}, options));
    } catch (const SpecError& wrong) {
        throw Problem(422, "The reports cannot be held against each other.", wrong.errors());
    }
}

}  // namespace

std::vector<Route> diff_routes(Service& service) {
    auto diffs = std::make_shared<std::atomic<int>>(0);
    Param run = Param::integer("run", "only this run of those that both have, with its FLIP maps as data: URIs", "", 0,
                               0, static_cast<double>(max_sweep_points) - 1);
    run.default_value = nullptr;
    run.optional = true;
    return {{.method = "GET",
             .pattern = std::string(reports_path) + "/{id}/diff",
             .id = "diffReports",
             .summary = "What changed from a done report to another one of the same spec, in pictures and in time",
             .query = {Param::text("against", "id of the report that came after", "", max_id_bytes).required(),
                       std::move(run)},
             .replies = {{200, "What changed", "application/json", "Diff"},
                         {404, "There is no such report", "application/problem+json", "Problem"},
                         {409, "A report is not done", "application/problem+json", "Problem"},
                         {422, "The reports are of different specs; `errors` names the fields",
                          "application/problem+json", "Problem"},
                         {429, "Other reports are being compared; Retry-After says when to come again",
                          "application/problem+json", "Problem"}},
             .handle = [&service, diffs](const Request& request) { return get_diff(service, *diffs, request); }}};
}

}  // namespace sheer::http
