#include "server/archive/sqlite_readiness.h"

#include "server/archive/sqlite_steps.h"

namespace sheer {

void SqliteReadiness::note_rendered() {
    m_archive.write([&](SQLite::Database& database) { write_rendered(database, m_archive.now_ms()); });
}

std::optional<std::int64_t> SqliteReadiness::last_rendered_ms() {
    return m_archive.read([](SQLite::Database& database) -> std::optional<std::int64_t> {
        SQLite::Statement row(database, "SELECT last_rendered_ms FROM health");
        if (!row.executeStep()) return std::nullopt;
        return row.getColumn(0).getInt64();
    });
}

std::string SqliteReadiness::lack_of_room() {
    return lack_of_room_after_tidying(m_archive);
}

}  // namespace sheer
