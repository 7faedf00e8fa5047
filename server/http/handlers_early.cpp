// The pictures of a report that is still being timed, from the folder of its renderer.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/text.h"
#include "server/jobs/limits.h"

namespace sheer::http {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t max_list_bytes = std::uintmax_t{16} << 20;

/// Where the renderer of a running report writes; none if there is no such folder on this machine.
std::optional<fs::path> output_folder(const Service& service, const ReportRecord& record) {
    if (record.status != Status::running) return std::nullopt;
    std::optional<fs::path> newest;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(service.scratch, none)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(record.id + "-") && (!newest || entry.path() > *newest)) newest = entry.path();
    }
    if (!newest) return std::nullopt;
    return *newest / "out";
}

/// None if the file is not there, or no longer, as its job has ended.
std::optional<std::string> bytes_of(const fs::path& file, std::uintmax_t max_bytes) {
    try {
        return read_file(file, max_bytes);
    } catch (const std::runtime_error&) {
        return std::nullopt;
    }
}

/// What the renderer says is not trusted: anything else than expected is left out.
answer::EarlyPictures read_list(const std::string& text, const std::string& url) {
    answer::EarlyPictures early;
    const json list = json::parse(text, nullptr, false);
    if (!list.is_object()) return early;
    if (const json point = list.value("point", json()); point.is_object()) early.point = point;
    for (const json& picture : list.value("pictures", json::array())) {
        if (!picture.is_object()) continue;
        const json label = picture.value("label", json()), sha256 = picture.value("sha256", json());
        if (label.is_string() && sha256.is_string() && is_sha256(sha256.get<std::string>()))
            early.pictures.push_back({label, fmt::format("{}/{}", url, sha256.get<std::string>())});
    }
    return early;
}

Answer list_pictures(Service& service, const Request& request) {
    const ReportRecord record = found_report(service.store, request);
    const auto folder = output_folder(service, record);
    const auto text = folder ? bytes_of(*folder / "early.json", max_list_bytes) : std::nullopt;
    const std::string url = fmt::format("{}/{}/early", reports_path, record.id);
    Response response = json_response(200, to_document(read_list(text.value_or(""), url)));
    response.headers.add("Cache-Control", "no-store");
    return response;
}

/// When the report is done, the picture is among its blobs; so a client that has just read the list always gets it.
Answer get_picture(Service& service, const Request& request) {
    const ReportRecord record = found_report(service.store, request);
    const std::string sha256 = request.path_values.at("sha256");
    const auto folder = is_sha256(sha256) ? output_folder(service, record) : std::nullopt;
    const auto bytes = folder ? bytes_of(*folder / sha256, max_picture_bytes) : std::nullopt;
    Response response;
    if (bytes && sha256_hex(*bytes) == sha256) {
        response = text_response(200, *bytes, "image/png");
    } else {
        const auto blob = service.store.blobs().open(sha256);
        if (!blob) throw Problem(404, "There is no such picture, or no longer.");
        response = {.status = 200, .headers = {}, .body = blob->content};
        response.headers.add("Content-Type", blob->media_type);
    }
    response.headers.add("Cache-Control", "no-store");
    return response;
}

}  // namespace

std::vector<Route> early_routes(Service& service) {
    const std::string pattern = std::string(reports_path) + "/{id}/early";
    const Reply not_found{404, "There is no such report or picture", "application/problem+json", "Problem"};
    return {
        {.method = "GET",
         .pattern = pattern,
         .id = "listEarlyPictures",
         .summary = "The pictures of a running report, before its times are measured",
         .description =
             "They are drawn first, so that they can be looked at meanwhile; of a sweep those of its present point. "
             "Empty before that, after the report has ended, and if it is rendered on another machine.",
         .replies = {{200, "The pictures so far", "application/json", "EarlyPictures"}, not_found},
         .handle = [&service](const Request& request) { return list_pictures(service, request); }},
        {.method = "GET",
         .pattern = pattern + "/{sha256}",
         .id = "getEarlyPicture",
         .summary = "One of these pictures",
         .replies = {{200, "The picture", "image/png", ""}, not_found},
         .handle = [&service](const Request& request) { return get_picture(service, request); }}};
}

}  // namespace sheer::http
