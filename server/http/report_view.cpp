#include "server/http/report_view.h"

#include <fmt/format.h>

#include "server/http/problem.h"
#include "server/jobs/clock.h"

namespace sheer::http {

using nlohmann::json;

namespace {

json error_json(const std::optional<JobError>& error) {
    if (!error) return nullptr;
    return {{"title", error->title}, {"detail", error->detail}};
}

json time_json(const std::optional<std::int64_t>& time_ms) {
    if (!time_ms) return nullptr;
    return utc_text(*time_ms);
}

}  // namespace

ReportRecord found_report(Store& store, const Request& request) {
    auto record = store.find(request.path_values.at("id"));
    if (!record) throw Problem(404, "There is no such report.");
    return std::move(*record);
}

std::string report_text(const ReportRecord& record) {
    if (record.status == Status::done) return record.report;
    const json view = {{"id", record.id},
                       {"status", status_text(record.status)},
                       {"progress", record.progress},
                       {"stage", record.stage},
                       {"error", error_json(record.error)},
                       {"created_at", utc_text(record.created_ms)},
                       {"finished_at", time_json(record.finished_ms)},
                       {"spec", json::parse(record.spec)},
                       {"spec_sha256", record.spec_sha256}};
    return view.dump();
}

json summary_json(const ReportSummary& summary) {
    return {{"id", summary.id},
            {"url", fmt::format("{}/{}", reports_path, summary.id)},
            {"status", status_text(summary.status)},
            {"progress", summary.progress},
            {"error", error_json(summary.error)},
            {"created_at", utc_text(summary.created_ms)},
            {"finished_at", time_json(summary.finished_ms)},
            {"title", summary.title},
            {"tags", summary.tags},
            {"scene", summary.scene},
            {"methods", summary.methods},
            {"spec_sha256", summary.spec_sha256},
            {"verdict", summary.verdict.empty() ? json() : json(summary.verdict)},
            {"preview", summary.preview}};
}

std::string event_name(Status status) {
    return is_final(status) ? std::string(status_text(status)) : "progress";
}

json event_json(const ReportRecord& record) {
    return {{"id", record.id},
            {"status", status_text(record.status)},
            {"progress", record.progress},
            {"stage", record.stage},
            {"error", error_json(record.error)}};
}

Response report_response(int status, const ReportRecord& record) {
    Response response = text_response(status, report_text(record), "application/json");
    response.headers.add("ETag", fmt::format("\"{}-{}\"", record.id, record.revision));
    response.headers.add("Cache-Control", "no-cache");
    return response;
}

}  // namespace sheer::http
