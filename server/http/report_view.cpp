#include "server/http/report_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/clock.h"
#include "server/http/problem.h"
#include "server/http/service.h"
#include "server/jobs/facets.h"
#include "server/jobs/limits.h"

namespace sheer::http {

using nlohmann::json;

namespace {

/// The status as reports write it.
report::Status written(Status status) {
    return from_document<report::Status>(std::string(status_text(status)));
}

std::optional<report::Error> written(const std::optional<JobError>& error) {
    if (!error) return std::nullopt;
    return report::Error{error->title, error->detail};
}

std::vector<report::DevicePart> written(const std::vector<PartState>& parts) {
    std::vector<report::DevicePart> all;
    for (const PartState& part : parts) {
        report::DevicePart& one = all.emplace_back();
        one.label = part.label;
        one.status = written(part.status);
        if (part.error) one.reason = fmt::format("{}: {}", part.error->title, part.error->detail);
    }
    return all;
}

/// "" for none.
std::string written(const std::optional<std::int64_t>& time_ms) {
    return time_ms ? utc_text(*time_ms) : "";
}

}  // namespace

ReportRecord found_report(Store& store, const Request& request) {
    auto record = store.reports().find(request.path_values.at("id"));
    if (!record) throw Problem(404, "There is no such report.");
    return std::move(*record);
}

json stored_json(const std::string& text, const std::string& what) {
    json value = json::parse(text, nullptr, false);
    if (!value.is_object()) throw DamagedData(what + " is not JSON");
    return value;
}

std::string report_text(const ReportRecord& record, const std::vector<Note>& notes) {
    if (record.status == Status::done) return record.report;
    report::UnfinishedReport view;
    view.id = record.id;
    view.status = written(record.status);
    view.progress = record.progress;
    view.error = written(record.error);
    view.created_at = utc_text(record.created_ms);
    view.finished_at = written(record.finished_ms);
    view.spec_sha256 = record.spec_sha256;
    view.spec = stored_json(record.spec, "the spec of report " + record.id);
    view.stage = record.stage;
    view.devices = written(record.parts);
    view.notes = notes;
    return to_document(view).dump();
}

std::vector<Note> queue_notes(const Service& service, const ReportRecord& record) {
    if (record.status != Status::queued) return {};
    const std::vector<std::string> wanted = wanted_devices(json::parse(record.spec, nullptr, false));
    if (wanted.empty()) return {};
    const auto workers = service.store.workers().list(in_sight_ms(service));
    std::vector<Note> notes;
    for (const std::string& device : wanted) {
        const auto part = std::ranges::find(record.parts, device, &PartState::label);
        const bool has_ended = part != record.parts.end() && is_final(part->status);
        if (has_ended || std::ranges::find(workers, device, &SeenWorker::label) != workers.end()) continue;
        notes.push_back(
            {"no-worker",
             fmt::format("No worker with the label \"{}\" was seen lately; the report waits for one.", device),
             "/device"});
    }
    return notes;
}

answer::ReportLine line_of(const ReportSummary& summary) {
    answer::ReportLine line;
    line.id = summary.id;
    line.status = written(summary.status);
    line.progress = summary.progress;
    line.error = written(summary.error);
    line.url = fmt::format("{}/{}", reports_path, summary.id);
    line.created_at = utc_text(summary.created_ms);
    line.finished_at = written(summary.finished_ms);
    line.title = summary.title;
    line.scene = summary.scene;
    line.tags = summary.tags;
    line.methods = summary.methods;
    line.spec_sha256 = summary.spec_sha256;
    if (!summary.verdict.empty()) line.verdict = summary.verdict;
    line.preview = summary.preview;
    line.device = summary.device;
    line.pinned = summary.pinned;
    line.broken = summary.broken;
    return line;
}

std::string picture_bytes(Store& store, const report::Picture& picture) {
    const auto blob = store.blobs().open(picture.sha256);
    if (!blob) throw DamagedData(fmt::format("the picture {} is missing", picture.sha256));
    return read_all(*blob->content, max_picture_bytes);
}

report::Report report_of(const ReportRecord& record) {
    const std::string what = "the report " + record.id;
    try {
        return from_document<report::Report>(stored_json(report_text(record), what));
    } catch (const DocumentError& wrong) {
        throw DamagedData(fmt::format("{}: {}", what, wrong.what()));
    }
}

ReportRecord done_record(Store& store, const std::string& id) {
    auto record = store.reports().find(id);
    if (!record) throw Problem(404, fmt::format("There is no report \"{}\".", id));
    if (record->status != Status::done)
        throw Problem(409, fmt::format("The report {} is not done: it is {}.", id, status_text(record->status)));
    return std::move(*record);
}

report::Report done_report(Store& store, const std::string& id) {
    return report_of(done_record(store, id));
}

std::string event_name(Status status) {
    return is_final(status) ? std::string(status_text(status)) : "progress";
}

json event_json(const ReportRecord& record) {
    answer::Event event;
    event.id = record.id;
    event.status = written(record.status);
    event.progress = record.progress;
    event.error = written(record.error);
    event.stage = record.stage;
    event.devices = written(record.parts);
    return to_document(event);
}

std::string report_etag(const ReportRecord& record, const std::vector<Note>& notes) {
    return fmt::format("\"{}-{}{}\"", record.id, record.revision, notes.empty() ? "" : "-noted");
}

Response report_response(int status, std::string text, std::string etag) {
    Response response = text_response(status, std::move(text), "application/json");
    response.headers.add("ETag", std::move(etag));
    response.headers.add("Cache-Control", "no-cache");
    return response;
}

Response report_response(int status, const ReportRecord& record, const std::vector<Note>& notes) {
    return report_response(status, report_text(record, notes), report_etag(record, notes));
}

}  // namespace sheer::http
