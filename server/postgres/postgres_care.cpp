#include "server/postgres/postgres_care.h"

#include <fmt/format.h>

#include "renderer/core/sha256.h"
#include "server/postgres/postgres_check.h"
#include "server/postgres/postgres_steps.h"
#include "server/postgres/report_rows.h"

namespace sheer::postgres {

using nlohmann::json;

CheckResult PostgresCare::check(bool repair) {
    CheckResult result = PostgresCheck(m_database).run();
    if (repair && result.is_damaged())
        throw StoreError(
            fmt::format("{} is damaged ({}); a PostgreSQL store is not repaired but restored from a backup",
                        m_database.address().text(), result.findings.front().text));
    return result;
}

Garbage PostgresCare::collect_garbage() {
    return m_database.write([](Connection& connection) {
        Garbage garbage;
        // Locked first, as by a deletion (postgres_reports.cpp).
        connection.run(
            "SELECT FROM blobs b WHERE NOT EXISTS (SELECT FROM report_blobs r WHERE r.sha256 = b.sha256) ORDER BY "
            "sha256 "
            "FOR UPDATE");
        const Rows blobs = connection.run(
            "WITH gone AS (DELETE FROM blobs b WHERE NOT EXISTS (SELECT FROM report_blobs r WHERE r.sha256 = b.sha256) "
            "RETURNING size_bytes) SELECT count(*), coalesce(sum(size_bytes), 0)::bigint FROM gone");
        garbage.rows = blobs.integer(0, 0);
        garbage.bytes = static_cast<std::uint64_t>(blobs.integer(0, 1));
        garbage.rows += connection
                            .run(
                                "DELETE FROM number_names n WHERE NOT EXISTS (SELECT FROM report_numbers r WHERE "
                                "r.names = n.id)")
                            .changed();
        return garbage;
    });
}

BackupResult PostgresCare::back_up(const std::filesystem::path&) {
    throw StoreError("a PostgreSQL store is backed up by pg_dump, or by PostgreSQL's own backups");
}

std::vector<StoredReport> PostgresCare::stored_reports() {
    return m_database.read_one_state([](Connection& connection) {
        const Rows rows = connection.run(
            "WITH own AS (SELECT newest, sum(size_bytes)::bigint AS bytes FROM (SELECT sha256, max(report_id) AS "
            "newest "
            "FROM report_blobs GROUP BY sha256) last JOIN blobs USING (sha256) GROUP BY newest) "
            "SELECT id, created_ms, octet_length(spec) + coalesce(length(packed), 0) + coalesce(own.bytes, 0), tags, "
            "EXISTS (SELECT FROM pins p WHERE p.report_id = id) OR EXISTS (SELECT FROM baselines b WHERE b.report_id = "
            "id) "
            "FROM reports LEFT JOIN documents d ON d.report_id = id LEFT JOIN own ON own.newest = id WHERE status IS "
            "NOT "
            "NULL ORDER BY id DESC");
        std::vector<StoredReport> all;
        for (int i = 0; i < rows.count(); ++i) {
            StoredReport report{.id = rows.text(i, 0), .created_ms = rows.integer(i, 1)};
            report.bytes = static_cast<std::uint64_t>(rows.integer(i, 2));
            const json tags = json::parse(rows.text(i, 3), nullptr, false);
            if (tags.is_object()) report.tags = tags;
            report.is_kept = rows.flag(i, 4);
            all.push_back(std::move(report));
        }
        return all;
    });
}

Care::Import PostgresCare::import_report(const ImportedReport& report) {
    return m_database.write([&](Connection& connection) {
        if (const std::string lack = find_lack_of_room(connection); !lack.empty()) throw StoreFull(lack);
        const Rows known = connection.run(
            "SELECT coalesce(d.sha256, '') FROM reports LEFT JOIN documents d ON d.report_id = id WHERE id = $1 FOR "
            "SHARE "
            "OF reports",
            {report.id});
        if (!known.empty() && known.text(0, 0) != sha256_hex(report.finished.report.dump())) return Import::differs;
        const int written = put_blobs(connection, report.finished, true);
        if (!known.empty()) return written > 0 ? Import::restored : Import::known;
        insert_report(connection, {.id = report.id, .spec = report.spec, .spec_sha256 = report.spec_sha256},
                      report.created_ms);
        finish_report(connection, report.id, report.finished);
        tell_change(connection);
        return Import::added;
    });
}

StoreSize PostgresCare::size() {
    return m_database.read([](Connection& connection) {
        const Rows row = connection.run(
            "SELECT pg_database_size(current_database()), (SELECT count(*) FROM reports WHERE status IS NOT NULL), "
            "(SELECT count(*) FROM blobs), (SELECT coalesce(sum(size_bytes), 0)::bigint FROM blobs), "
            "(SELECT count(*) FROM assets), (SELECT coalesce(sum(size_bytes), 0)::bigint FROM assets)");
        return StoreSize{.database_bytes = static_cast<std::uint64_t>(row.integer(0, 0)),
                         .picture_bytes = static_cast<std::uint64_t>(row.integer(0, 3)),
                         .upload_bytes = static_cast<std::uint64_t>(row.integer(0, 5)),
                         .reports = row.integer(0, 1),
                         .pictures = row.integer(0, 2),
                         .uploads = row.integer(0, 4)};
    });
}

}  // namespace sheer::postgres
