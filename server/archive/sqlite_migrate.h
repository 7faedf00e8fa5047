#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include "server/storage/data_folder.h"

namespace sheer {

/// The version of a new archive.
std::int64_t archive_version();

/// Inside a transaction: brings the database to the newest version; an empty one gets its tables. Throws StoreError for
/// a version that this program does not know.
void migrate_archive(SQLite::Database& database, const DataFolder& folder);

}  // namespace sheer
