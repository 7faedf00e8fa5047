#include "server/archive/sqlite_watch.h"

#include <algorithm>
#include <thread>

#include "server/archive/sqlite_archive.h"
#include "server/archive/sqlite_open.h"

namespace sheer {

using namespace std::chrono_literals;

namespace {

constexpr std::chrono::milliseconds look_interval = 50ms;

}  // namespace

SqliteWatch::SqliteWatch(const DataFolder& folder) : m_database(open_reader(folder)), m_seen(version()) {}

std::int64_t SqliteWatch::version() {
    try {
        return m_database.execAndGet("PRAGMA data_version").getInt64();
    } catch (const SQLite::Exception& error) {
        throw_store_error(error);
    }
}

bool SqliteWatch::wait(std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (true) {
        const std::int64_t now = version();
        if (now != m_seen) {
            m_seen = now;
            return true;
        }
        const auto left = deadline - std::chrono::steady_clock::now();
        if (left <= 0ms) return false;
        std::this_thread::sleep_for(std::min<std::chrono::steady_clock::duration>(left, look_interval));
    }
}

}  // namespace sheer
