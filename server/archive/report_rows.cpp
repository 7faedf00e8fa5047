#include "server/archive/report_rows.h"

#include <SQLiteCpp/VariadicBind.h>

#include "server/archive/sqlite_index.h"
#include "server/archive/sqlite_parts.h"
#include "server/archive/sqlite_steps.h"
#include "server/archive/sqlite_trends.h"
#include "server/jobs/facets.h"

namespace sheer {

using nlohmann::json;

void insert_report(SQLite::Database& database, const NewReport& report, std::int64_t created_ms) {
    const Facets facets = facets_of(json::parse(report.spec));
    SQLite::Statement insert(database,
                             "INSERT INTO reports (id, status, created_ms, title, scene, spec, spec_sha256, "
                             "idempotency_key, body_sha256) VALUES (?, 'queued', ?, ?, ?, ?, ?, ?, ?)");
    SQLite::bind(insert, report.id, created_ms, facets.title, facets.scene, report.spec, report.spec_sha256);
    if (report.idempotency) {
        insert.bind(7, report.idempotency->key);
        insert.bind(8, report.idempotency->body_sha256);
    }
    insert.exec();
    for (std::size_t i = 0; i < facets.methods.size(); ++i) {
        SQLite::Statement method(database, "INSERT INTO report_methods VALUES (?, ?, ?)");
        SQLite::bind(method, report.id, static_cast<std::int64_t>(i), facets.methods[i]);
        method.exec();
    }
    for (const auto& [name, value] : facets.tags.items()) {
        SQLite::Statement tag(database, "INSERT INTO report_tags VALUES (?, ?, ?)");
        SQLite::bind(tag, report.id, name, value.get<std::string>());
        tag.exec();
    }
    insert_job(database, report);
    add_to_index(database, {.id = report.id, .facets = facets, .spec_sha256 = report.spec_sha256});
}

void finish_report(SQLite::Database& database, SqliteBlobs& blobs, const std::string& id,
                   const FinishedReport& finished) {
    SQLite::Statement done(
        database,
        "UPDATE reports SET status = 'done', progress = 1, stage = '', revision = revision + 1, "
        "died_of = NULL, finished_ms = ?, verdict = ?, preview = ?, report = '', lease_owner = NULL, "
        "lease_until_ms = NULL WHERE id = ?");
    const json preview = preview_of(finished.report);
    SQLite::bind(done, finished.finished_ms, finished.report.value("verdict", ""));
    if (!preview.is_null()) done.bind(3, preview.dump());
    done.bind(4, id);
    done.exec();
    SQLite::Statement document(database, "INSERT INTO documents VALUES (?1, sheer_sha256(?2), sheer_pack(?2))");
    SQLite::bind(document, id, finished.report.dump());
    document.exec();
    seal_report(database, id);
    if (!finished.numbers.names.empty()) add_numbers(database, id, finished.numbers);
    add_outcome_to_index(database, id, finished.report.value("verdict", ""), renderer_of(finished.report));
    for (const BlobName& blob : finished.blobs) blobs.add(database, id, blob);
}

}  // namespace sheer
