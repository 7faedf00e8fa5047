#include "server/cli/open_store.h"

#include <cstdlib>

#include "renderer/core/clock.h"
#include "server/archive/sqlite_store.h"
#include "server/postgres/postgres_store.h"

namespace sheer::cli {

std::unique_ptr<Store> open_store(const std::string& url, const std::filesystem::path& data, LeaseRules rules) {
    if (url.empty()) return std::make_unique<SqliteStore>(data, rules, system_now_ms);
    return std::make_unique<PostgresStore>(url, data, rules);
}

std::vector<std::string> take_store_environment(const std::string& url) {
    std::vector<std::string> taken;
    if (!url.empty()) taken.push_back(std::string(store_variable) + "=" + url);
    const char* const password_variable = "PGPASSWORD";
    if (const char* const password = std::getenv(password_variable); password != nullptr && !url.empty())
        taken.push_back(std::string(password_variable) + "=" + password);
    unsetenv(store_variable);
    unsetenv(password_variable);
    return taken;
}

}  // namespace sheer::cli
