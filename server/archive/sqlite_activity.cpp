#include "server/archive/sqlite_activity.h"

#include <algorithm>

namespace sheer {

namespace {

constexpr char part_separator = '\x1f';
constexpr const char* lost_leases = "lost leases";
constexpr const char* stage_kind = "stage";
constexpr std::int64_t forgotten_after_ms = 86'400'000;

void add_to_counter(SQLite::Database& database, const std::string& name, double value) {
    SQLite::Statement add(database,
                          "INSERT INTO counters VALUES (?1, ?2) ON CONFLICT (name) DO UPDATE SET value = value + ?2");
    SQLite::bind(add, name, value);
    add.exec();
}

void add_use(SQLite::Database& database, std::int64_t now_ms, const std::string& token, double seconds,
             std::int64_t upload_bytes) {
    const std::int64_t hour = now_ms / use_hour_ms;
    SQLite::Statement old(database, "DELETE FROM token_use WHERE hour <= ?");
    old.bind(1, hour - use_hours);
    old.exec();
    SQLite::Statement add(database,
                          "INSERT INTO token_use VALUES (?, ?, ?, ?) ON CONFLICT (token, hour) DO UPDATE SET seconds = "
                          "seconds + excluded.seconds, upload_bytes = upload_bytes + excluded.upload_bytes");
    SQLite::bind(add, token, hour, seconds, upload_bytes);
    add.exec();
}

}  // namespace

void count_lost_lease(SQLite::Database& database) {
    add_to_counter(database, lost_leases, 1);
}

void count_stage_time(SQLite::Database& database, const SqliteArchive& archive, const std::string& id) {
    SQLite::Statement row(database, "SELECT stage, lease_until_ms FROM reports WHERE id = ?");
    row.bind(1, id);
    if (!row.executeStep()) return;
    const std::string kind = kind_of_stage(row.getColumn(0).getString());
    const std::int64_t last_ms = row.getColumn(1).getInt64() - archive.rules().lease_ms;
    row.reset();
    const double seconds = static_cast<double>(std::max<std::int64_t>(archive.now_ms() - last_ms, 0)) / 1000;
    add_to_counter(database, std::string(stage_kind) + part_separator + (kind.empty() ? "starting" : kind), seconds);
    SQLite::Statement sender(database, "SELECT token FROM jobs WHERE report_id = ? AND token <> ''");
    sender.bind(1, id);
    if (!sender.executeStep()) return;
    const std::string token = sender.getColumn(0).getString();
    sender.reset();
    add_use(database, archive.now_ms(), token, seconds, 0);
}

TokenUse use_of(SQLite::Database& database, std::int64_t now_ms, const std::string& token) {
    TokenUse use;
    SQLite::Statement jobs(database, "SELECT count(*) FROM jobs WHERE token = ?");
    jobs.bind(1, token);
    if (jobs.executeStep()) use.jobs = jobs.getColumn(0).getInt64();
    SQLite::Statement day(database,
                          "SELECT total(seconds), coalesce(sum(upload_bytes), 0), min(hour) FROM token_use WHERE "
                          "token = ? AND hour > ?");
    SQLite::bind(day, token, now_ms / use_hour_ms - use_hours);
    if (!day.executeStep() || day.getColumn(2).isNull()) return use;
    use.seconds = day.getColumn(0).getDouble();
    use.upload_bytes = day.getColumn(1).getInt64();
    use.less_at_ms = (day.getColumn(2).getInt64() + use_hours) * use_hour_ms;
    return use;
}

TokenUse SqliteUsage::of(const std::string& token) {
    return m_archive.read([&](SQLite::Database& database) { return use_of(database, m_archive.now_ms(), token); });
}

void SqliteUsage::add_upload(const std::string& token, std::int64_t bytes) {
    m_archive.write([&](SQLite::Database& database) { add_use(database, m_archive.now_ms(), token, 0, bytes); });
}

ActivityCounts SqliteActivity::counts() {
    return m_archive.read([](SQLite::Database& database) {
        ActivityCounts counts;
        SQLite::Statement statuses(database, "SELECT facet, reports FROM facets WHERE id <= 5");
        while (statuses.executeStep()) {
            const std::string facet = statuses.getColumn(0).getString();
            counts.reports[facet.substr(facet.find(part_separator) + 1)] = statuses.getColumn(1).getInt64();
        }
        SQLite::Statement oldest(database,
                                 "SELECT created_ms FROM reports WHERE status = 'queued' ORDER BY id LIMIT 1");
        if (oldest.executeStep()) counts.oldest_queued_ms = oldest.getColumn(0).getInt64();
        SQLite::Statement counters(database, "SELECT name, value FROM counters");
        while (counters.executeStep()) {
            const std::string name = counters.getColumn(0).getString();
            const double value = counters.getColumn(1).getDouble();
            const std::size_t at = name.find(part_separator);
            if (name == lost_leases) counts.lost_leases = static_cast<std::int64_t>(value);
            if (at != std::string::npos) counts.stage_seconds[name.substr(at + 1)] = value;
        }
        SQLite::Statement owners(database,
                                 "SELECT coalesce(label, 'local'), count(DISTINCT lease_owner) FROM reports LEFT JOIN "
                                 "workers ON name = lease_owner WHERE status = 'running' GROUP BY 1");
        counts.workers["local"] = 0;
        while (owners.executeStep()) counts.workers[owners.getColumn(0).getString()] = owners.getColumn(1).getInt64();
        return counts;
    });
}

void SqliteWorkers::note(const SeenWorker& worker) {
    m_archive.write([&](SQLite::Database& database) {
        SQLite::Statement gone(database, "DELETE FROM workers WHERE seen_ms < ?");
        gone.bind(1, m_archive.now_ms() - forgotten_after_ms);
        gone.exec();
        SQLite::Statement note(
            database,
            "INSERT INTO workers VALUES (?1, ?2, ?3, ?4) ON CONFLICT (name) DO UPDATE SET label = ?2, "
            "driver = ?3, seen_ms = ?4");
        SQLite::bind(note, worker.name, worker.label, worker.driver, m_archive.now_ms());
        note.exec();
    });
}

std::vector<SeenWorker> SqliteWorkers::list(std::int64_t age_ms) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement rows(
            database,
            "SELECT name, label, driver, max(seen_ms, coalesce(lease_until_ms - ?1, 0)) AS seen, coalesce(id, '') FROM "
            "workers LEFT JOIN reports ON status = 'running' AND lease_owner = name WHERE seen >= ?2 ORDER BY label, "
            "name");
        SQLite::bind(rows, m_archive.rules().lease_ms, m_archive.now_ms() - age_ms);
        std::vector<SeenWorker> all;
        while (rows.executeStep())
            all.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString(), rows.getColumn(2).getString(),
                           rows.getColumn(3).getInt64(), rows.getColumn(4).getString()});
        return all;
    });
}

}  // namespace sheer
