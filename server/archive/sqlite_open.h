#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>

namespace sheer {

/// What a database of ours says of itself in its header: "Shee" in ASCII. `file` and others can tell it by that.
inline constexpr int archive_application_id = 0x53686565;

/// Opens FOLDER/archive.sqlite, and makes it where there is nothing yet. Throws StoreError that names the file and
/// leaves it as it is
///   where it is missing, empty or cut though FOLDER holds pictures or uploads: an archive that begins anew would hide
///   them and lose them,
///   where it is no SQLite database, or one of another program.
SQLite::Database open_archive(const std::filesystem::path& folder);

/// Throws StoreError if SQLite finds the database damaged. Reads all of it, so only one that is small is looked at.
void check_archive(SQLite::Database& database, const std::filesystem::path& folder);

}  // namespace sheer
