#include <fmt/format.h>

#include <charconv>

#include "renderer/files/html.h"
#include "renderer/report/markdown.h"
#include "renderer/report/report.h"
#include "server/http/body_cache.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/report_zip.h"
#include "server/http/service.h"
#include "server/http/text.h"

namespace sheer::http {

using Removal = ReportArchive::Removal;

namespace {

// The page contains its style, scripts and pictures; the sandbox keeps it from acting with the service's origin.
constexpr const char* page_policy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline' data:; "
    "frame-ancestors 'self'; "
    "sandbox allow-scripts allow-downloads";

ReportRecord found_report(Service& service, const Request& request) {
    return found_report(service.store, request);
}

constexpr std::size_t kept_pages_bytes = 32 << 20, kept_reports_bytes = 16 << 20;
// A longer report is sent by the pool's threads, so that the others do not wait while it is copied.
constexpr std::size_t longest_kept_report_bytes = 256 << 10;

Answer get_report(Service& service, BodyCache& reports, const Request& request) {
    // Before the report is read: what is written meanwhile makes it another one.
    const std::optional<std::int64_t> version = service.store.version();
    const ReportRecord record = found_report(service, request);
    Response response = report_response(200, record, queue_notes(service, record));
    const auto& text = std::get<std::string>(response.body);
    if (version && record.status == Status::done && text.size() <= longest_kept_report_bytes)
        reports.keep(record.id, {text, report_etag(record), *version});
    return response;
}

/// A done report never changes, but any process may delete it: so it is known only until something is written to the
/// store, and its seal was checked when it was read.
std::optional<Response> known_report(Service& service, BodyCache& reports, const Request& request) {
    const auto kept = reports.find(request.path_values.at("id"));
    if (kept == nullptr || service.store.version() != kept->version) return std::nullopt;
    return report_response(200, kept->body, kept->etag);
}

Answer get_html(Service& service, BodyCache& pages, const Request& request) {
    const ReportRecord record = done_record(service.store, request.path_values.at("id"));
    const auto read_picture = [&service](const report::Picture& picture) {
        return picture_bytes(service.store, picture);
    };
    const std::string page = pages.get(record.id, [&] { return report_html(report_of(record), read_picture); });
    Response response = text_response(200, page, "text/html; charset=utf-8");
    response.headers.add("Content-Security-Policy", page_policy);
    response.headers.add("ETag", fmt::format("\"{}-page\"", record.id));
    response.headers.add("Cache-Control", "no-cache");
    return response;
}

Answer get_junit(Service& service, const Request& request) {
    const ReportRecord record = found_report(service, request);
    if (!is_final(record.status))
        throw Problem(409, fmt::format("The report has not ended: it is {}.", status_text(record.status)));
    return text_response(200, report_junit(report_of(record)), "application/xml");
}

Answer get_summary(Service& service, const Request& request) {
    const ReportRecord record = found_report(service, request);
    if (!is_final(record.status))
        throw Problem(409, fmt::format("The report has not ended: it is {}.", status_text(record.status)));
    return text_response(200, report_markdown(report_of(record)), "text/markdown; charset=utf-8");
}

Answer get_zip(Service& service, const Request& request) {
    const std::string id = request.path_values.at("id");
    Response response{.status = 200, .headers = {}, .body = report_zip(service.store, id)};
    response.headers.add("Content-Type", "application/zip");
    response.headers.add("Content-Disposition", fmt::format("attachment; filename=\"sheer-{}.zip\"", id));
    return response;
}

Answer delete_report(Service& service, const Request& request) {
    const std::string id = request.path_values.at("id");
    switch (service.store.reports().remove(id)) {
        case Removal::not_found:
            break;
        case Removal::deleted:
            return Response{.status = 204, .headers = {}, .body = {}};
        case Removal::cancelled:
            return report_response(200, found_report(service, request));
        case Removal::cancelling:
            return report_response(202, found_report(service, request));
        case Removal::pinned:
            throw Problem(409, "The report is pinned: unpin it first.");
        case Removal::accepted:
            throw Problem(409, "The report is accepted in a baseline: forget it there first.");
    }
    throw Problem(404, "There is no such report.");
}

std::int64_t last_event_id(const Request& request) {
    const std::string text = request.headers.find("Last-Event-ID").value_or("");
    std::int64_t id = 0;
    std::from_chars(text.data(), text.data() + text.size(), id);
    return id;
}

/// Events describe the current state, not its history: their ids are revisions, and a client that was disconnected gets
/// one event for all it missed.
Answer get_events(Service& service, const Request& request) {
    const ReportRecord record = found_report(service, request);
    const std::int64_t last_id = last_event_id(request);
    // This tells an EventSource not to reconnect.
    if (is_final(record.status) && record.revision <= last_id)
        return Response{.status = 204, .headers = {}, .body = {}};
    EventStream stream{.head = text_response(200, "", "text/event-stream")};
    stream.next = [&service, id = record.id, sent = last_id]() mutable -> EventChunk {
        const auto now = service.store.reports().find(id);
        if (!now) return {.text = "", .last = true};
        if (now->revision == sent) return {};
        sent = now->revision;
        return {event_text(sent, event_name(now->status), event_json(*now).dump()), is_final(now->status)};
    };
    return stream;
}

Route route(std::string method, const std::string& suffix, std::string id, std::string summary,
            std::vector<Reply> replies, Handler handle) {
    replies.push_back({404, "There is no such report", "application/problem+json", "Problem"});
    return {.method = std::move(method),
            .pattern = std::string(reports_path) + "/{id}" + suffix,
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle)};
}

}  // namespace

std::vector<Route> report_routes(Service& service) {
    const Reply not_done{409, "The report is not done", "application/problem+json", "Problem"};
    Route events = route(
        "GET", "/events", "getReportEvents", "Progress as server-sent events, then done, failed or cancelled",
        {{200, "The events, whose ids are revisions of the report", "text/event-stream", "ReportEvent", {}, "Events"},
         {204, "There is nothing after Last-Event-ID, and nothing will come", "", ""}},
        [&service](const Request& request) { return get_events(service, request); });
    Route remove =
        route("DELETE", "", "deleteReport", "Cancel a queued or running report, or delete one that has ended",
              {{412, "If-Match or If-None-Match is not satisfied", "application/problem+json", "Problem"},
               {200, "It was queued and is cancelled", "application/json", "AnyReport", {"ETag"}, "QueuedReport"},
               {202, "It is running and will be cancelled", "application/json", "AnyReport", {"ETag"}, "QueuedReport"},
               {204, "It had ended and is deleted", "", ""},
               {409, "It is pinned, or accepted in a baseline", "application/problem+json", "Problem"}},
              [&service](const Request& request) { return delete_report(service, request); });
    remove.headers = {{"If-Match", "the expected ETag of the report"}};
    remove.etag = [&service](const Request& request) {
        const ReportRecord record = found_report(service, request);
        return report_etag(record, queue_notes(service, record));
    };
    events.description =
        "Each event has the current state; a client that was away gets one event for all it missed. The stream ends "
        "with the event `done`, `failed` or `cancelled`.";
    events.headers = {{"Last-Event-ID", "the id of the last event that the client received"}};
    const auto reports = std::make_shared<BodyCache>(kept_reports_bytes);
    Route report =
        route("GET", "", "getReport", "A report, even while it is queued or running",
              {{200, "The report", "application/json", "AnyReport", {"ETag"}}},
              [&service, reports](const Request& request) { return get_report(service, *reports, request); });
    report.known = [&service, reports](const Request& request) { return known_report(service, *reports, request); };
    return {
        std::move(report),
        std::move(events),
        route("GET", "/report.html", "getReportPage", "A done report as one self-contained page",
              {{200, "The page", "text/html", "", {"ETag"}}, not_done},
              [&service, pages = std::make_shared<BodyCache>(kept_pages_bytes)](const Request& request) {
                  return get_html(service, *pages, request);
              }),
        route("GET", "/junit.xml", "getReportJunit",
              "The checks of a report as JUnit XML; one that failed or was cancelled has an <error>",
              {{200, "The checks", "application/xml", "", {}, "Junit"},
               {409, "The report has not ended", "application/problem+json", "Problem"}},
              [&service](const Request& request) { return get_junit(service, request); }),
        route("GET", "/summary.md", "getReportSummary",
              "The verdict, the checks and the methods of a report as markdown",
              {{200, "The summary", "text/markdown", "", {}, "Summary"},
               {409, "The report has not ended", "application/problem+json", "Problem"}},
              [&service](const Request& request) { return get_summary(service, request); }),
        route("GET", "/report.zip", "getReportZip",
              "A done report with everything: report.json, report.html, junit.xml, summary.md and the pictures",
              {{200, "The files", "application/zip", "", {"Content-Disposition"}}, not_done},
              [&service](const Request& request) { return get_zip(service, request); }),
        std::move(remove),
    };
}

}  // namespace sheer::http
