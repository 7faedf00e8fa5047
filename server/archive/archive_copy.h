#pragma once
#include "server/jobs/care.h"
#include "server/storage/data_folder.h"

namespace sheer {

/// Copies the archive in `from`, which may be in use, as it is at one moment, into the folder `to`, which must not
/// exist or be empty. Every file that is copied has been compared with its hash. Throws StoreError.
BackupResult copy_archive(const DataFolder& from, const DataFolder& to);

/// Throws StoreError if the folder exists and is not empty.
void require_empty(const std::filesystem::path& folder);

}  // namespace sheer
