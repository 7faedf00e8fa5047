#include "server/http/report_view.h"

#include <fmt/format.h>

#include "server/archive/blob_store.h"
#include "server/http/problem.h"
#include "server/http/service.h"
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

json stored_json(const std::string& text, const std::string& what) {
    json value = json::parse(text, nullptr, false);
    if (!value.is_object()) throw DamagedFile(what + " is not JSON");
    return value;
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
                       {"spec", stored_json(record.spec, "the spec of report " + record.id)},
                       {"spec_sha256", record.spec_sha256}};
    return view.dump();
}

json summary_json(const ReportSummary& summary) {
    json line = {{"id", summary.id},
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
    if (!summary.broken.empty()) line["broken"] = summary.broken;
    return line;
}

std::string picture_bytes(Store& store, const json& image) {
    const auto sha256 = image.at("sha256").get<std::string>();
    const auto blob = store.find_blob(sha256);
    if (!blob) throw DamagedFile(fmt::format("the picture {} is missing", sha256));
    return read_file(blob->path, max_picture_bytes);
}

json done_report_json(Store& store, const std::string& id) {
    const auto record = store.find(id);
    if (!record) throw Problem(404, fmt::format("There is no report \"{}\".", id));
    if (record->status != Status::done)
        throw Problem(409, fmt::format("The report {} is not done: it is {}.", id, status_text(record->status)));
    return stored_json(record->report, "the report " + id);
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

std::string report_etag(const ReportRecord& record) {
    return fmt::format("\"{}-{}\"", record.id, record.revision);
}

Response report_response(int status, const ReportRecord& record) {
    Response response = text_response(status, report_text(record), "application/json");
    response.headers.add("ETag", report_etag(record));
    response.headers.add("Cache-Control", "no-cache");
    return response;
}

}  // namespace sheer::http
