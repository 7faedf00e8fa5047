#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <mutex>
#include <optional>

#include "server/storage/data_folder.h"

namespace sheer {

/// The number of the last commit that a connection of its own sees, which never writes: every commit of another
/// connection changes it, whichever process made it.
class SqliteVersion {
  public:
    /// Throws StoreError.
    explicit SqliteVersion(const DataFolder& folder);
    /// Nothing if it cannot be read at once. Reads shared memory, which takes microseconds. For any thread.
    std::optional<std::int64_t> read();

  private:
    std::mutex m_mutex;  ///< guards what follows
    SQLite::Database m_database;
    SQLite::Statement m_statement;
};

}  // namespace sheer
