#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/jobs/store.h"

namespace sheer {

/// Every picture that `report` names, wherever it stands, once: the objects with `sha256`, `url` and `media_type`.
/// Their files are `folder`/<sha256>.
std::vector<BlobFile> named_blobs(const nlohmann::json& report, const std::filesystem::path& folder);

/// What `sheer render --out folder` left, made into the report of this job. Throws StoreError if it is not whole: a
/// missing file, a picture whose bytes have another hash, a media type that is no image's, a report that is not JSON.
FinishedReport read_report_folder(const std::filesystem::path& folder, const Lease& lease, std::int64_t finished_ms);

}  // namespace sheer
