#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"

namespace sheer::cli {

/// The environment variable that names the store, unless the command line does.
inline constexpr const char* store_variable = "SHEER_STORE";
inline constexpr const char* store_help =
    "URL of a PostgreSQL database, instead of the archive in the data folder: postgresql://USER@HOST/DATABASE";

/// The PostgreSQL store of `url`, with `data` for what is only on this machine; if `url` is "", the SQLite store in
/// `data`. Throws StoreError, also for another URL.
std::unique_ptr<Store> open_store(const std::string& url, const std::filesystem::path& data, LeaseRules rules);

/// Removes from the environment what opens the store, so that child processes, which run what others sent, do not
/// inherit it, and returns it for those that need it, as NAME=VALUE. Call it when the store is open, before there are
/// other threads.
std::vector<std::string> take_store_environment(const std::string& url);

}  // namespace sheer::cli
