#include "server/postgres/postgres_activity.h"

#include "server/jobs/status.h"
#include "server/postgres/counter_names.h"
#include "server/postgres/postgres_steps.h"

namespace sheer::postgres {

namespace {

constexpr std::int64_t forgotten_after_ms = 86'400'000;

}  // namespace

ActivityCounts PostgresActivity::counts() {
    return m_database.read_one_state([](Connection& connection) {
        ActivityCounts counts;
        for (const Status status : {Status::queued, Status::running, Status::done, Status::failed, Status::cancelled})
            counts.reports[std::string(status_text(status))] = 0;
        const Rows statuses = connection.run(
            "SELECT status, count(*) FROM reports WHERE status IS NOT NULL GROUP BY status UNION ALL SELECT status, "
            "count(*) FROM jobs GROUP BY status");
        for (int i = 0; i < statuses.count(); ++i) counts.reports[statuses.text(i, 0)] = statuses.integer(i, 1);
        const Rows oldest = connection.run(
            "SELECT created_ms FROM jobs j JOIN reports r ON r.id = j.report_id WHERE j.status = 'queued' ORDER BY "
            "j.report_id LIMIT 1");
        if (!oldest.empty()) counts.oldest_queued_ms = oldest.integer(0, 0);
        const Rows counters = connection.run("SELECT name, sum(value) FROM counters GROUP BY name");
        for (int i = 0; i < counters.count(); ++i) {
            const std::string name = counters.text(i, 0);
            if (name == lost_leases_counter) counts.lost_leases = static_cast<std::int64_t>(counters.number(i, 1));
            if (name.starts_with(stage_counter_prefix))
                counts.stage_seconds[name.substr(stage_counter_prefix.size())] = counters.number(i, 1);
        }
        const Rows owners = connection.run(
            "SELECT coalesce(w.label, 'local'), count(DISTINCT lease_owner) FROM jobs LEFT JOIN workers w ON w.name = "
            "lease_owner WHERE status = 'running' GROUP BY 1");
        counts.workers["local"] = 0;
        for (int i = 0; i < owners.count(); ++i) counts.workers[owners.text(i, 0)] = owners.integer(i, 1);
        return counts;
    });
}

void PostgresWorkers::note(const SeenWorker& worker) {
    m_database.write_lightly([&](Connection& connection) {
        connection.run(
            "INSERT INTO workers VALUES ($1, $2, $3, now_ms()) ON CONFLICT (name) DO UPDATE SET label = "
            "excluded.label, "
            "driver = excluded.driver, seen_ms = excluded.seen_ms",
            {worker.name, worker.label, worker.driver});
        connection.run(
            "DELETE FROM workers WHERE name IN (SELECT name FROM workers WHERE seen_ms < now_ms() - $1 FOR UPDATE SKIP "
            "LOCKED)",
            {forgotten_after_ms});
    });
}

std::vector<SeenWorker> PostgresWorkers::list(std::int64_t age_ms) {
    return m_database.read([&](Connection& connection) {
        const Rows rows = connection.run(
            "SELECT name, w.label, driver, seen, coalesce(job, '') FROM (SELECT w.*, j.report_id AS job, "
            "greatest(seen_ms, "
            "j.lease_until_ms - $1) AS seen FROM workers w LEFT JOIN jobs j ON j.status = 'running' AND j.lease_owner "
            "= "
            "w.name) w WHERE seen >= now_ms() - $2 ORDER BY w.label, name",
            {m_database.rules().lease_ms, age_ms});
        std::vector<SeenWorker> all;
        for (int i = 0; i < rows.count(); ++i)
            all.push_back({rows.text(i, 0), rows.text(i, 1), rows.text(i, 2), rows.integer(i, 3), rows.text(i, 4)});
        return all;
    });
}

TokenUse PostgresUsage::of(const std::string& token) {
    return m_database.read([&](Connection& connection) { return use_of(connection, token); });
}

void PostgresUsage::add_upload(const std::string& token, std::int64_t bytes) {
    m_database.write([&](Connection& connection) { add_use(connection, token, 0, bytes); });
}

void PostgresReadiness::note_rendered() {
    m_database.write_lightly([](Connection& connection) { sheer::postgres::note_rendered(connection); });
}

std::optional<std::int64_t> PostgresReadiness::last_rendered_ms() {
    return m_database.read([](Connection& connection) -> std::optional<std::int64_t> {
        const Rows row = connection.run("SELECT max(last_rendered_ms) FROM health");
        if (row.is_null(0, 0)) return std::nullopt;
        return row.integer(0, 0);
    });
}

std::string PostgresReadiness::lack_of_room() {
    return m_database.read([](Connection& connection) { return find_lack_of_room(connection); });
}

}  // namespace sheer::postgres
