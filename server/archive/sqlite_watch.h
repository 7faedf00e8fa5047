#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include "server/jobs/change_watch.h"
#include "server/storage/data_folder.h"

namespace sheer {

/// Uses a connection that never writes, so that its `data_version` changes with every commit of another connection.
/// Reading it only reads shared memory and takes microseconds.
class SqliteWatch : public ChangeWatch {
  public:
    /// Throws StoreError.
    explicit SqliteWatch(const DataFolder& folder);
    bool wait(std::chrono::milliseconds limit) override;

  private:
    std::int64_t version();

    SQLite::Database m_database;
    std::int64_t m_seen;
};

}  // namespace sheer
