#pragma once
#include <chrono>
#include <mutex>
#include <string>

#include "server/postgres/database.h"
#include "server/storage/content_folder.h"
#include "server/storage/data_folder.h"

namespace sheer::postgres {

/// Copies of pictures and uploads on this machine, for child processes that are closed off from the network. Those that
/// were not used for a day are removed. Can be shared by processes.
class LocalCopies {
  public:
    /// Makes the folders. Throws StoreError.
    LocalCopies(Database& database, const DataFolder& folder);

    /// See Store::bring_here().
    void bring(const std::string& text);

  private:
    void bring(const std::string& table, ContentFolder& folder, const std::vector<std::string>& names);
    void remove_unused();

    Database& m_database;
    ContentFolder m_blobs, m_assets;
    std::mutex m_mutex;
    std::chrono::steady_clock::time_point m_next_removal{};  ///< guarded by m_mutex
};

}  // namespace sheer::postgres
