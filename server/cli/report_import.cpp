#include "server/cli/report_import.h"

#include <fmt/format.h>

#include "renderer/command/command.h"
#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "renderer/results/report.h"
#include "server/cli/packed_files.h"
#include "server/http/paths.h"
#include "server/jobs/limits.h"
#include "server/jobs/report_id.h"
#include "server/worker/report_folder.h"

namespace sheer::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

report::Report report_in(const fs::path& file) {
    const auto text = read_zipped(
        file, [](const std::string& name) { return name == "report.json"; }, max_report_bytes);
    if (!text) throw UsageError(fmt::format("{} has no report.json", file.string()));
    const json document = json::parse(*text, nullptr, false);
    try {
        if (document.is_object()) return from_document<report::Report>(document);
    } catch (const DocumentError& wrong) {
        throw UsageError(fmt::format("report.json in {} is not a report: {}", file.string(), wrong.what()));
    }
    throw UsageError(fmt::format("report.json in {} is not a JSON object", file.string()));
}

/// Its pictures refer to the service's blobs again, not to files of the ZIP.
void relink(report::Report& report) {
    const auto each = [](report::Pictures& pictures) {
        for (auto& [key, picture] : pictures) picture.url = fmt::format("{}/{}", http::blobs_path, picture.sha256);
    };
    for (report::Run& run : report.runs) {
        each(run.reference.images);
        for (report::Result& result : run.results) each(result.images);
    }
}

/// The time of one of its fields.
std::int64_t time_of(const std::string& text, const char* field, const fs::path& file) {
    const auto time_ms = time_of_utc_text(text);
    if (!time_ms) throw UsageError(fmt::format("{} of the report in {} is not a time", field, file.string()));
    return *time_ms;
}

std::string picture_in(const fs::path& file, const std::string& sha256) {
    const auto bytes = read_zipped(
        file, [&](const std::string& name) { return fs::path(name).stem() == sha256; }, max_picture_bytes);
    if (!bytes) throw UsageError(fmt::format("{} lacks the picture {}", file.string(), sha256));
    if (sha256_hex(*bytes) != sha256)
        throw UsageError(fmt::format("the picture {} in {} has other bytes", sha256, file.string()));
    return *bytes;
}

}  // namespace

ImportedReport read_report_zip(const fs::path& file) {
    report::Report report = report_in(file);
    if (!is_report_id(report.id)) throw UsageError(fmt::format("the report in {} has no id", file.string()));
    if (report.status != report::Status::done)
        throw UsageError(fmt::format("the report in {} is not done", file.string()));
    relink(report);
    ImportedReport imported{.id = report.id, .created_ms = time_of(report.created_at, "created_at", file)};
    imported.spec = report.spec.dump();
    imported.spec_sha256 = report.spec_sha256;
    if (sha256_hex(imported.spec) != imported.spec_sha256)
        throw UsageError(fmt::format("the spec of the report in {} has another hash", file.string()));
    imported.finished.finished_ms = time_of(report.finished_at, "finished_at", file);
    imported.finished.numbers = numbers_of(report);
    imported.finished.blobs = named_blobs(report);
    imported.finished.read_blob = [file](const std::string& sha256) { return picture_in(file, sha256); };
    for (const BlobName& blob : imported.finished.blobs) {
        try {
            check_picture_name(blob);
        } catch (const StoreError& wrong) {
            throw UsageError(fmt::format("{}: {}", file.string(), wrong.what()));
        }
        picture_in(file, blob.sha256);
    }
    imported.finished.report = to_document(report);
    return imported;
}

}  // namespace sheer::cli
