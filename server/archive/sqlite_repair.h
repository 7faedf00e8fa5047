#pragma once
#include <string>
#include <vector>

#include "server/archive/sqlite_check.h"

namespace sheer {

/// Moves damaged and unnamed files, and reports whose text or row is damaged, into DATA/quarantine/TIME, and makes the
/// index for searching again. Returns what it did, as sentences.
std::vector<std::string> repair_archive(SqliteArchive& archive, const DataFolder& folder, const SqliteCheck& check);

}  // namespace sheer
