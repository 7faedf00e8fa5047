#include "server/archive/sqlite_baselines.h"

namespace sheer {

namespace {

bool is_accepted(SQLite::Database& database, const AcceptedReport& accepted) {
    SQLite::Statement row(database, "SELECT 1 FROM baselines WHERE name = ? AND report_id = ?");
    SQLite::bind(row, accepted.name, accepted.report_id);
    return row.executeStep();
}

/// The status of a report; "" if there is none.
std::string status_of_report(SQLite::Database& database, const std::string& id) {
    SQLite::Statement row(database, "SELECT status FROM reports WHERE id = ?");
    row.bind(1, id);
    return row.executeStep() ? row.getColumn(0).getString() : "";
}

}  // namespace

Baselines::Acceptance SqliteBaselines::accept(const AcceptedReport& accepted) {
    const Acceptance result = m_archive.write([&](SQLite::Database& database) {
        const std::string status = status_of_report(database, accepted.report_id);
        if (status.empty()) return Acceptance::not_found;
        if (status != "done") return Acceptance::not_done;
        const bool is_known = is_accepted(database, accepted);
        SQLite::Statement insert(database, "INSERT OR REPLACE INTO baselines VALUES (?, ?, ?, ?, ?, '')");
        SQLite::bind(insert, accepted.name, accepted.report_id, m_archive.now_ms(), accepted.by, accepted.reason);
        insert.exec();
        SQLite::Statement seal(database,
                               "UPDATE baselines SET seal = (SELECT seal FROM sealed_baselines WHERE name = ?1 AND "
                               "report_id = ?2) WHERE name = ?1 AND report_id = ?2");
        SQLite::bind(seal, accepted.name, accepted.report_id);
        seal.exec();
        return is_known ? Acceptance::renewed : Acceptance::added;
    });
    m_archive.checkpoint();
    return result;
}

std::vector<AcceptedReport> SqliteBaselines::list(const std::string& name) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement rows(database,
                               "SELECT name, report_id, accepted_ms, accepted_by, reason FROM baselines "
                               "WHERE ?1 = '' OR name = ?1 ORDER BY name, accepted_ms DESC, report_id DESC");
        rows.bind(1, name);
        std::vector<AcceptedReport> all;
        while (rows.executeStep())
            all.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString(), rows.getColumn(2).getInt64(),
                           rows.getColumn(3).getString(), rows.getColumn(4).getString()});
        return all;
    });
}

std::size_t SqliteBaselines::forget(const std::string& name, const std::string& report_id) {
    const auto forgotten = m_archive.essential([&](SQLite::Database& database) {
        SQLite::Statement gone(database, "DELETE FROM baselines WHERE name = ?1 AND (?2 = '' OR report_id = ?2)");
        SQLite::bind(gone, name, report_id);
        return static_cast<std::size_t>(gone.exec());
    });
    m_archive.checkpoint();
    return forgotten;
}

}  // namespace sheer
