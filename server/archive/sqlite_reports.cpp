#include "server/archive/sqlite_reports.h"

#include <fmt/format.h>

#include "server/archive/sqlite_parts.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

namespace {

std::optional<std::int64_t> optional_int(const SQLite::Column& column) {
    if (column.isNull()) return std::nullopt;
    return column.getInt64();
}

/// A damaged index can lead to the row or the text of another report, which is whole by its own hash.
void require_own_text(SQLite::Database& database, const std::string& id) {
    SQLite::Statement same(database,
                           "SELECT 1 FROM report_seals s JOIN sealed_reports r ON r.report_id = s.report_id "
                           "WHERE s.report_id = ? AND s.sha256 = r.sha256");
    same.bind(1, id);
    if (!same.executeStep()) throw DamagedData(fmt::format("report {} is not as it was when it ended", id));
}

}  // namespace

std::optional<ReportRecord> SqliteReports::find(const std::string& id) {
    return m_archive.read([&](SQLite::Database& database) -> std::optional<ReportRecord> {
        SQLite::Statement row(
            database,
            "SELECT status, progress, stage, revision, created_ms, finished_ms, spec, spec_sha256, "
            "error_title, error_detail, sha256, packed FROM reports LEFT JOIN documents ON report_id = id "
            "WHERE id = ?");
        row.bind(1, id);
        if (!row.executeStep()) return std::nullopt;
        ReportRecord record{.id = id, .status = status_of(row.getColumn(0))};
        record.progress = row.getColumn(1).getDouble();
        record.stage = row.getColumn(2).getString();
        record.revision = row.getColumn(3).getInt64();
        record.created_ms = row.getColumn(4).getInt64();
        record.finished_ms = optional_int(row.getColumn(5));
        record.spec = row.getColumn(6).getString();
        record.spec_sha256 = row.getColumn(7).getString();
        record.error = error_of(row.getColumn(8), row.getColumn(9));
        if (record.status == Status::done) {
            record.report = document_in(row.getColumn(10), row.getColumn(11), id);
            require_own_text(database, id);
        }
        if (!is_final(record.status)) record.parts = read_part_states(database, id, record.spec);
        return record;
    });
}

ReportArchive::Removal SqliteReports::remove(const std::string& id) {
    std::vector<std::string> candidates;
    const Removal result = m_archive.essential([&](SQLite::Database& database) {
        candidates.clear();
        SQLite::Statement row(database, "SELECT status FROM reports WHERE id = ?");
        row.bind(1, id);
        if (!row.executeStep()) return Removal::not_found;
        const Status status = status_of(row.getColumn(0));
        row.reset();
        if (status == Status::queued) {
            end_attempt(database, m_archive, id, {}, Status::cancelled);
            return Removal::cancelled;
        }
        if (status == Status::running) {
            SQLite::Statement ask(database, "UPDATE reports SET cancel_requested = 1 WHERE id = ?");
            ask.bind(1, id);
            ask.exec();
            return Removal::cancelling;
        }
        SQLite::Statement accepted(database, "SELECT 1 FROM baselines WHERE report_id = ?");
        accepted.bind(1, id);
        if (accepted.executeStep()) return Removal::accepted;
        SQLite::Statement pinned(database, "SELECT 1 FROM pins WHERE report_id = ?");
        pinned.bind(1, id);
        if (pinned.executeStep()) return Removal::pinned;
        SQLite::Statement named(database, "SELECT sha256 FROM report_blobs WHERE report_id = ?");
        named.bind(1, id);
        while (named.executeStep()) candidates.push_back(named.getColumn(0).getString());
        named.reset();
        SQLite::Statement gone(database, "DELETE FROM reports WHERE id = ?");
        gone.bind(1, id);
        gone.exec();
        try_again_what_lacked_room(database);
        return Removal::deleted;
    });
    if (result == Removal::deleted) m_blobs.remove(candidates);
    if (result == Removal::cancelled) m_blobs.remove_of_parts(id);
    m_archive.checkpoint();
    m_archive.room().restore_reserve();
    return result;
}

}  // namespace sheer
