#include <fmt/format.h>

#include "renderer/core/clock.h"
#include "server/http/byte_range.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/text.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr std::size_t max_text_bytes = 200;

/// None if it is not given. Throws Problem (400).
std::optional<std::int64_t> time_in(const json& query, const char* name) {
    const std::string text = query[name];
    if (text.empty()) return std::nullopt;
    const auto time_ms = time_of_utc_text(text);
    if (!time_ms)
        throw Problem(400, "The query is wrong.",
                      {{fmt::format("/{}", name), "must be a day or a time in UTC, such as 2026-11-27T12:00:00Z"}});
    return time_ms;
}

ListFilter filter_of(const json& query) {
    ListFilter filter{.q = query["q"], .tags = query["tag"], .methods = query["method"], .scene = query["scene"]};
    filter.device = query["device"];
    filter.spec_sha256 = query["spec_sha256"];
    if (query["verdict"].is_string()) filter.verdict = query["verdict"];
    filter.since_ms = time_in(query, "since");
    filter.until_ms = time_in(query, "until");
    filter.limit = query["limit"];
    if (query["status"].is_string()) filter.status = status_from(query["status"].get<std::string>());
    const std::string cursor = query["cursor"];
    if (cursor.empty()) return filter;
    const auto id = id_of_cursor(cursor);
    if (!id) throw Problem(400, "The query is wrong.", {{"/cursor", "is not a next_cursor that this service gave"}});
    filter.before_id = *id;
    return filter;
}

Answer list_reports(Service& service, const Request& request) {
    const ReportPage page = service.store.reports().list(filter_of(request.query));
    answer::ReportList list{.count = page.count, .count_is_exact = page.count_is_exact};
    for (const ReportSummary& summary : page.reports) list.reports.push_back(line_of(summary));
    if (page.more) list.next_cursor = cursor_after(page.reports.back().id);
    return json_response(200, to_document(list));
}

/// None if the client wants the whole.
std::optional<ByteRange> wanted_range(const Request& request, const std::string& etag, std::uint64_t size) {
    const auto field = request.headers.find("Range");
    if (!field || request.headers.find("If-Range").value_or(etag) != etag) return std::nullopt;
    return byte_range(*field, size);
}

Answer get_blob(Service& service, const Request& request) {
    const std::string sha256 = request.path_values.at("sha256");
    const auto blob = service.store.blobs().open(sha256);
    if (!blob) throw Problem(404, "There is no such blob.");
    const std::string etag = fmt::format("\"{}\"", sha256);
    const std::uint64_t size = blob->content->size_bytes();
    Response response{.status = 200, .headers = {}, .body = blob->content};
    if (const auto range = wanted_range(request, etag, size)) {
        if (*range == ByteRange{})
            throw Problem(416, fmt::format("The picture has only {} bytes.", size))
                .with("Content-Range", fmt::format("bytes */{}", size));
        response.status = 206;
        response.body = slice_of(blob->content, *range);
        response.headers.add("Content-Range", fmt::format("bytes {}-{}/{}", range->begin, range->end - 1, size));
    }
    response.headers.add("Content-Type", blob->media_type);
    response.headers.add("Accept-Ranges", "bytes");
    response.headers.add("ETag", etag);
    response.headers.add("Cache-Control", "public, max-age=31536000, immutable");
    return response;
}

std::vector<Param> list_query() {
    Param status{.name = "status", .kind = Param::Kind::choice, .summary = "status of the reports"};
    status.optional = true;
    for (const Status each : {Status::queued, Status::running, Status::done, Status::failed, Status::cancelled})
        status.choices.emplace_back(status_text(each));
    Param verdict{.name = "verdict", .kind = Param::Kind::choice, .summary = "verdict of the reports"};
    verdict.optional = true;
    verdict.choices = {"passed", "failed", "undecided", "none"};
    return {Param::integer("limit", "greatest number of reports", "", 20, 1, 100),
            Param::text("cursor", "next_cursor of the previous page", "", max_text_bytes),
            Param::text("q", "words, each of which begins a word of the title or of a tag's value; case is ignored", "",
                        max_text_bytes),
            Param::text("tag", "name of a tag, or name:value; each that is given", "", max_text_bytes),
            Param::text("method", "id of one of the compared methods; each that is given", "", max_text_bytes),
            Param::text("scene", "type of the scene", "", max_text_bytes),
            Param::text("device", "name of the renderer, or one word of it; case is ignored", "", max_text_bytes),
            Param::text("spec_sha256", "SHA-256 of the spec", "", max_text_bytes),
            Param::text("since", "created then or later: a day or a time in UTC, such as 2026-11-27T12:00:00Z", "",
                        max_text_bytes),
            Param::text("until", "created then or earlier; a day means its first moment", "", max_text_bytes),
            std::move(status),
            std::move(verdict)};
}

}  // namespace

std::vector<Route> archive_routes(Service& service) {
    return {{.method = "GET",
             .pattern = reports_path,
             .id = "listReports",
             .summary = "The archive, newest first",
             .description =
                 "Filters are and-ed. `next_cursor` leads to the next page; reports that come in meanwhile do not "
                 "move it.",
             .query = list_query(),
             .replies = {{200, "A page of the list", "application/json", "ReportList"}},
             .handle = [&service](const Request& request) { return list_reports(service, request); },
             .repeatable = {"tag", "method"}},
            {.method = "GET",
             .pattern = std::string(blobs_path) + "/{sha256}",
             .id = "getBlob",
             .summary = "A picture",
             .description = "Its address is the SHA-256 of its bytes, which are checked before they are sent.",
             .headers = {{"If-None-Match", "the ETag of the copy that the client has"},
                         {"Range", "one range of bytes, such as bytes=1000-"},
                         {"If-Range", "the ETag of the copy of which the client has a part"}},
             .replies = {{200, "The picture; it never changes", "image/*", "", {"ETag", "Accept-Ranges"}},
                         {206,
                          "The range of its bytes that Range asks for",
                          "image/*",
                          "",
                          {"ETag", "Accept-Ranges", "Content-Range"}},
                         {304, "The client has it already", "", ""},
                         {404, "There is no such blob", "application/problem+json", "Problem"},
                         {416,
                          "It has none of the bytes that Range asks for",
                          "application/problem+json",
                          "Problem",
                          {"Content-Range"}},
                         {500, "Its bytes are damaged", "application/problem+json", "Problem"}},
             .handle = [&service](const Request& request) { return get_blob(service, request); }}};
}

}  // namespace sheer::http
