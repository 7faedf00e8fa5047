#include "server/archive/sqlite_pins.h"

#include "server/archive/sqlite_steps.h"

namespace sheer {

namespace {

std::optional<Pin> pin_of(SQLite::Database& database, const std::string& report_id) {
    SQLite::Statement row(database, "SELECT pinned_ms, pinned_by, reason FROM pins WHERE report_id = ?");
    row.bind(1, report_id);
    if (!row.executeStep()) return std::nullopt;
    return Pin{report_id, row.getColumn(0).getInt64(), row.getColumn(1).getString(), row.getColumn(2).getString()};
}

}  // namespace

Pins::Pinning SqlitePins::pin(const Pin& pin) {
    const Pinning result = m_archive.write([&](SQLite::Database& database) {
        SQLite::Statement row(database, "SELECT status FROM reports WHERE id = ?");
        row.bind(1, pin.report_id);
        if (!row.executeStep()) return Pinning::not_found;
        if (!is_final(status_of(row.getColumn(0)))) return Pinning::not_final;
        const bool is_known = pin_of(database, pin.report_id).has_value();
        SQLite::Statement insert(database, "INSERT OR REPLACE INTO pins VALUES (?1, ?2, ?3, ?4, '')");
        SQLite::bind(insert, pin.report_id, m_archive.now_ms(), pin.by, pin.reason);
        insert.exec();
        SQLite::Statement seal(database,
                               "UPDATE pins SET seal = (SELECT seal FROM sealed_pins WHERE report_id = ?1) "
                               "WHERE report_id = ?1");
        seal.bind(1, pin.report_id);
        seal.exec();
        return is_known ? Pinning::renewed : Pinning::added;
    });
    m_archive.checkpoint();
    return result;
}

std::optional<Pin> SqlitePins::find(const std::string& report_id) {
    return m_archive.read([&](SQLite::Database& database) { return pin_of(database, report_id); });
}

bool SqlitePins::unpin(const std::string& report_id) {
    const bool was_pinned = m_archive.essential([&](SQLite::Database& database) {
        SQLite::Statement gone(database, "DELETE FROM pins WHERE report_id = ?");
        gone.bind(1, report_id);
        return gone.exec() > 0;
    });
    m_archive.checkpoint();
    return was_pinned;
}

}  // namespace sheer
