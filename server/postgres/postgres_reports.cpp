#include "server/postgres/postgres_reports.h"

#include <fmt/format.h>

#include "server/postgres/postgres_parts.h"
#include "server/postgres/postgres_steps.h"
#include "server/storage/stored_report.h"

namespace sheer::postgres {

namespace {

/// Whether a table names this report.
bool is_named_in(Connection& connection, const char* table, const std::string& id) {
    return !connection.run(fmt::format("SELECT FROM {} WHERE report_id = $1 LIMIT 1", table), {id}).empty();
}

/// Of a final report.
ReportArchive::Removal delete_report(Connection& connection, const std::string& id) {
    using Removal = ReportArchive::Removal;
    if (is_named_in(connection, "baselines", id)) return Removal::accepted;
    if (is_named_in(connection, "pins", id)) return Removal::pinned;
    remove_pictures(connection, id);
    connection.run("DELETE FROM reports WHERE id = $1", {id});
    try_again_what_lacked_room(connection);
    tell_change(connection);
    return Removal::deleted;
}

}  // namespace

std::optional<ReportRecord> PostgresReports::find(const std::string& id) {
    return m_database.read([&](Connection& connection) -> std::optional<ReportRecord> {
        const Rows row = connection.run(
            "SELECT coalesce(j.status, r.status), coalesce(j.progress, r.progress), coalesce(j.stage, ''), "
            "coalesce(j.revision, r.revision), created_ms, finished_ms, spec, spec_sha256, error_title, error_detail, "
            "d.sha256, d.packed FROM reports r LEFT JOIN jobs j ON j.report_id = r.id LEFT JOIN documents d ON "
            "d.report_id = r.id WHERE r.id = $1",
            {id});
        if (row.empty()) return std::nullopt;
        ReportRecord record{.id = id, .status = status_at(row, 0, 0)};
        record.progress = row.number(0, 1);
        record.stage = row.text(0, 2);
        record.revision = row.integer(0, 3);
        record.created_ms = row.integer(0, 4);
        if (!row.is_null(0, 5)) record.finished_ms = row.integer(0, 5);
        record.spec = row.text(0, 6);
        record.spec_sha256 = row.text(0, 7);
        record.error = error_at(row, 0, 8);
        if (!is_final(record.status)) record.parts = read_part_states(connection, id, record.spec);
        if (record.status != Status::done) return record;
        if (row.is_null(0, 11)) throw DamagedData(fmt::format("the text of report {} is missing", id));
        record.report = stored_report_text(row.bytes(0, 11), row.text(0, 10), id);
        return record;
    });
}

ReportArchive::Removal PostgresReports::remove(const std::string& id) {
    return m_database.write([&](Connection& connection) {
        const Rows job = connection.run("SELECT status FROM jobs WHERE report_id = $1 FOR UPDATE", {id});
        if (!job.empty() && status_at(job, 0, 0) == Status::queued) {
            end_attempt(connection, id, {}, Status::cancelled);
            return Removal::cancelled;
        }
        if (!job.empty()) {
            connection.run("UPDATE jobs SET cancel_requested = true WHERE report_id = $1", {id});
            tell_change(connection);
            return Removal::cancelling;
        }
        // The lock keeps it from being accepted or pinned meanwhile.
        if (connection.run("SELECT FROM reports WHERE id = $1 FOR UPDATE", {id}).empty()) return Removal::not_found;
        return delete_report(connection, id);
    });
}

}  // namespace sheer::postgres
