#include "server/worker/report_folder.h"

#include <algorithm>

#include "renderer/report/report.h"
#include "server/archive/blob_store.h"
#include "server/jobs/clock.h"

namespace sheer {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t max_report_bytes = std::uintmax_t{128} << 20;
constexpr std::uintmax_t max_picture_bytes = std::uintmax_t{512} << 20;

bool is_picture(const json& value) {
    return value.is_object() && value.contains("url") && value.value("sha256", json()).is_string() &&
           value.value("media_type", json()).is_string();
}

void check(const BlobFile& blob) {
    if (!is_sha256(blob.sha256)) throw StoreError("a picture's sha256 is none: " + blob.sha256);
    // A blob is served under the service's own origin, so it must not be a page.
    if (!blob.media_type.starts_with("image/") || blob.media_type.starts_with("image/svg"))
        throw StoreError("a picture has the media type " + blob.media_type);
    if (sha256_hex(read_file(blob.path, max_picture_bytes)) != blob.sha256)
        throw StoreError("picture " + blob.sha256 + " has other bytes");
}

}  // namespace

std::vector<BlobFile> named_blobs(const json& report, const fs::path& folder) {
    std::vector<BlobFile> blobs;
    std::vector<const json*> open{&report};
    while (!open.empty()) {
        const json& value = *open.back();
        open.pop_back();
        if (is_picture(value)) {
            const std::string sha256 = value["sha256"];
            if (std::ranges::none_of(blobs, [&](const BlobFile& blob) { return blob.sha256 == sha256; }))
                blobs.push_back({sha256, value["media_type"], folder / sha256});
        } else if (value.is_structured()) {
            for (const json& inner : value) open.push_back(&inner);
        }
    }
    return blobs;
}

FinishedReport read_report_folder(const fs::path& folder, const Lease& lease, std::int64_t finished_ms) {
    json report = json::parse(read_file(folder / "report.json", max_report_bytes), nullptr, false);
    if (!report.is_object()) throw StoreError("report.json is not a JSON object");
    report["id"] = lease.id;
    report["status"] = status_text(Status::done);
    report["progress"] = 1.0;
    report["error"] = nullptr;
    report["created_at"] = utc_text(lease.created_ms);
    report["finished_at"] = utc_text(finished_ms);
    report["spec"] = json::parse(lease.spec);
    report["spec_sha256"] = lease.spec_sha256;
    FinishedReport finished{.report = std::move(report), .finished_ms = finished_ms};
    finished.blobs = named_blobs(finished.report, folder);
    std::ranges::for_each(finished.blobs, check);
    return finished;
}

}  // namespace sheer
