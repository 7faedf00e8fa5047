#include "server/archive/sqlite_version.h"

#include "server/archive/sqlite_open.h"

namespace sheer {

SqliteVersion::SqliteVersion(const DataFolder& folder)
    : m_database(open_reader(folder)), m_statement(m_database, "PRAGMA data_version") {
    // Whoever asks would rather do without the number than wait for it.
    m_database.setBusyTimeout(0);
}

std::optional<std::int64_t> SqliteVersion::read() {
    const std::lock_guard lock(m_mutex);
    try {
        m_statement.reset();
        if (!m_statement.executeStep()) return std::nullopt;
        const std::int64_t version = m_statement.getColumn(0).getInt64();
        m_statement.reset();
        return version;
    } catch (const SQLite::Exception&) {
        m_statement.tryReset();
        return std::nullopt;
    }
}

}  // namespace sheer
