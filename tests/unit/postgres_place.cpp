#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "server/postgres/connection.h"
#include "store_fixture.h"

namespace sheer::test {

namespace {

std::string server_url() {
    const char* const url = std::getenv("SHEER_TEST_STORE");
    return url == nullptr ? "" : url;
}

void run_on(const std::string& url, const std::string& sql) {
    postgres::Connection(postgres::Address(url)).script(sql);
}

/// A database for the tests of this process, since making one takes longer than a test.
class OwnDatabase {
  public:
    OwnDatabase() : m_name(fmt::format("unit_tests_{}", getpid())) {
        run_on(server_url(), "CREATE DATABASE " + m_name);
    }
    OwnDatabase(const OwnDatabase&) = delete;
    OwnDatabase& operator=(const OwnDatabase&) = delete;
    ~OwnDatabase() {
        try {
            run_on(server_url(), fmt::format("DROP DATABASE {} WITH (FORCE)", m_name));
        } catch (const StoreError&) {
            // The server has ended before.
        }
    }

    std::string url() const {
        std::string url = server_url();
        const std::size_t begin = url.find('/', url.find("//") + 2) + 1;
        return url.replace(begin, url.find('?') - begin, m_name);
    }

  private:
    const std::string m_name;
};

std::string empty_database() {
    static const OwnDatabase database;
    run_on(database.url(), "DROP SCHEMA IF EXISTS sheer CASCADE");
    return database.url();
}

}  // namespace

PostgresPlace::PostgresPlace(std::filesystem::path data) : m_data(std::move(data)), m_url(empty_database()) {}

void PostgresPlace::run(const std::string& sql) const {
    run_on(m_url, sql);
}

bool has_postgres() {
    return !server_url().empty();
}

}  // namespace sheer::test
