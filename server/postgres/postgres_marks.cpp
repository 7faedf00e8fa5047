#include "server/postgres/postgres_marks.h"

#include "server/postgres/postgres_steps.h"

namespace sheer::postgres {

namespace {

/// The status of a report, "" while it has a job; nothing if there is no such report. Until the end of the transaction
/// it is not deleted.
std::optional<std::string> kept_status(Connection& connection, const std::string& id) {
    const Rows row = connection.run("SELECT coalesce(status, '') FROM reports WHERE id = $1 FOR SHARE", {id});
    if (row.empty()) return std::nullopt;
    return row.text(0, 0);
}

}  // namespace

Baselines::Acceptance PostgresBaselines::accept(const AcceptedReport& accepted) {
    return m_database.write([&](Connection& connection) {
        const auto status = kept_status(connection, accepted.report_id);
        if (!status) return Acceptance::not_found;
        if (*status != status_text(Status::done)) return Acceptance::not_done;
        // xmax is 0 in a row that was just added.
        const Rows row = connection.run(
            "INSERT INTO baselines VALUES ($1, $2, now_ms(), $3, $4) ON CONFLICT (name, report_id) DO UPDATE SET "
            "accepted_ms = excluded.accepted_ms, accepted_by = excluded.accepted_by, reason = excluded.reason "
            "RETURNING "
            "xmax = 0",
            {accepted.name, accepted.report_id, accepted.by, accepted.reason});
        return row.flag(0, 0) ? Acceptance::added : Acceptance::renewed;
    });
}

std::vector<AcceptedReport> PostgresBaselines::list(const std::string& name) {
    return m_database.read([&](Connection& connection) {
        const Rows rows = connection.run(
            "SELECT name, report_id, accepted_ms, accepted_by, reason FROM baselines WHERE $1 = '' OR name = $1 ORDER "
            "BY "
            "name, accepted_ms DESC, report_id DESC",
            {name});
        std::vector<AcceptedReport> all;
        for (int i = 0; i < rows.count(); ++i)
            all.push_back({rows.text(i, 0), rows.text(i, 1), rows.integer(i, 2), rows.text(i, 3), rows.text(i, 4)});
        return all;
    });
}

std::size_t PostgresBaselines::forget(const std::string& name, const std::string& report_id) {
    return m_database.write([&](Connection& connection) {
        return static_cast<std::size_t>(
            connection.run("DELETE FROM baselines WHERE name = $1 AND ($2 = '' OR report_id = $2)", {name, report_id})
                .changed());
    });
}

Pins::Pinning PostgresPins::pin(const Pin& pin) {
    return m_database.write([&](Connection& connection) {
        const auto status = kept_status(connection, pin.report_id);
        if (!status) return Pinning::not_found;
        if (status->empty()) return Pinning::not_final;
        const Rows row = connection.run(
            "INSERT INTO pins VALUES ($1, now_ms(), $2, $3) ON CONFLICT (report_id) DO UPDATE SET pinned_ms = "
            "excluded.pinned_ms, pinned_by = excluded.pinned_by, reason = excluded.reason RETURNING xmax = 0",
            {pin.report_id, pin.by, pin.reason});
        return row.flag(0, 0) ? Pinning::added : Pinning::renewed;
    });
}

std::optional<Pin> PostgresPins::find(const std::string& report_id) {
    return m_database.read([&](Connection& connection) -> std::optional<Pin> {
        const Rows row =
            connection.run("SELECT pinned_ms, pinned_by, reason FROM pins WHERE report_id = $1", {report_id});
        if (row.empty()) return std::nullopt;
        return Pin{report_id, row.integer(0, 0), row.text(0, 1), row.text(0, 2)};
    });
}

bool PostgresPins::unpin(const std::string& report_id) {
    return m_database.write([&](Connection& connection) {
        return connection.run("DELETE FROM pins WHERE report_id = $1", {report_id}).changed() > 0;
    });
}

}  // namespace sheer::postgres
