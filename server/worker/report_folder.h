#pragma once
#include <filesystem>
#include <vector>

#include "renderer/results/report.h"
#include "server/jobs/job_queue.h"

namespace sheer {

/// The file of every picture that `report` names, each once.
std::vector<BlobName> named_blobs(const report::Report& report);

/// The numbers that are followed over time.
ReportNumbers numbers_of(const report::Report& report);

/// Throws StoreError if a picture's hash is none, or its type is not an image's: a blob is served under the service's
/// own origin, so it must not be a page.
void check_picture_name(const BlobName& blob);

/// The report of this job, with its numbers and the names of its pictures; those are to be read by `read_blob`.
FinishedReport finished_report_of(report::Report report, const Lease& lease, std::int64_t finished_ms);

/// Reads the output of `sheer render --out folder`, in which each picture is `folder`/<sha256>, as the report of this
/// job. Throws StoreError if it is not valid: a missing file, a picture whose bytes have another hash, a media type
/// that is not an image's, a report.json that is not a report.
FinishedReport read_report_folder(const std::filesystem::path& folder, const Lease& lease, std::int64_t finished_ms);

}  // namespace sheer
