#include "server/worker/report_folder.h"

#include <algorithm>

#include "renderer/core/clock.h"
#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "renderer/files/trend_values.h"
#include "server/jobs/limits.h"
#include "server/jobs/store_errors.h"

namespace sheer {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

report::Report read_report(const fs::path& file) {
    const json document = json::parse(read_file(file, max_report_bytes), nullptr, false);
    if (!document.is_object()) throw StoreError("report.json is not a JSON object");
    try {
        return from_document<report::Report>(document);
    } catch (const DocumentError& wrong) {
        throw StoreError(std::string("report.json is not a report: ") + wrong.what());
    }
}

}  // namespace

std::vector<BlobName> named_blobs(const report::Report& report) {
    std::vector<BlobName> blobs;
    for (const report::Picture& picture : report.pictures())
        if (std::ranges::find(blobs, picture.sha256, &BlobName::sha256) == blobs.end())
            blobs.push_back({picture.sha256, picture.media_type});
    return blobs;
}

ReportNumbers numbers_of(const report::Report& report) {
    const TrendValues values = trend_values(report);
    return {trend_names_text(values), trend_numbers(values)};
}

void check_picture_name(const BlobName& blob) {
    if (!is_sha256(blob.sha256)) throw StoreError("a picture's sha256 is none: " + blob.sha256);
    if (!blob.media_type.starts_with("image/") || blob.media_type.starts_with("image/svg"))
        throw StoreError("a picture has the media type " + blob.media_type);
}

FinishedReport finished_report_of(report::Report report, const Lease& lease, std::int64_t finished_ms) {
    report.id = lease.id;
    report.status = report::Status::done;
    report.progress = 1;
    report.error.reset();
    report.created_at = utc_text(lease.created_ms);
    report.finished_at = utc_text(finished_ms);
    report.spec = json::parse(lease.spec);
    report.spec_sha256 = lease.spec_sha256;
    FinishedReport finished{.report = to_document(report), .finished_ms = finished_ms};
    finished.numbers = numbers_of(report);
    finished.blobs = named_blobs(report);
    return finished;
}

FinishedReport read_report_folder(const fs::path& folder, const Lease& lease, std::int64_t finished_ms) {
    FinishedReport finished = finished_report_of(read_report(folder / "report.json"), lease, finished_ms);
    finished.read_blob = [folder](const std::string& sha256) { return read_file(folder / sha256, max_picture_bytes); };
    for (const BlobName& blob : finished.blobs) {
        check_picture_name(blob);
        if (sha256_hex(finished.read_blob(blob.sha256)) != blob.sha256)
            throw StoreError("picture " + blob.sha256 + " has other bytes");
    }
    return finished;
}

}  // namespace sheer
