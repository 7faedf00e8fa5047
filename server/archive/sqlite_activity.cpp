#include "server/archive/sqlite_activity.h"

#include <algorithm>

namespace sheer {

namespace {

constexpr char part_separator = '\x1f';
constexpr const char* lost_leases = "lost leases";
constexpr const char* stage_kind = "stage";

void add_to_counter(SQLite::Database& database, const std::string& name, double value) {
    SQLite::Statement add(database,
                          "INSERT INTO counters VALUES (?1, ?2) ON CONFLICT (name) DO UPDATE SET value = value + ?2");
    SQLite::bind(add, name, value);
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
    const auto elapsed_ms = static_cast<double>(std::max<std::int64_t>(archive.now_ms() - last_ms, 0));
    add_to_counter(database, std::string(stage_kind) + part_separator + (kind.empty() ? "starting" : kind),
                   elapsed_ms / 1000);
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
        SQLite::Statement owners(database, "SELECT count(DISTINCT lease_owner) FROM reports WHERE status = 'running'");
        if (owners.executeStep()) counts.workers["local"] = owners.getColumn(0).getInt64();
        return counts;
    });
}

}  // namespace sheer
