#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include "server/storage/data_folder.h"

namespace sheer {

/// The application id in the header of our databases: "Shee" in ASCII. `file` and other tools recognize them by it.
inline constexpr int archive_application_id = 0x53686565;

/// Opens the folder's database, or makes it in an empty folder. Throws a StoreError that names the file, and does not
/// change it, if it is missing, empty or truncated although the folder holds pictures or uploads (a new archive would
/// hide and lose them), and if it is not a SQLite database or belongs to another program.
SQLite::Database open_archive(const DataFolder& folder);
/// The same for a connection that never writes.
SQLite::Database open_reader(const DataFolder& folder);

/// Throws StoreError if SQLite finds the database damaged. It reads all of it, so only a small database is checked.
void check_archive(SQLite::Database& database, const DataFolder& folder);

}  // namespace sheer
