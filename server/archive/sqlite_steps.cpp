#include "server/archive/sqlite_steps.h"

#include <fmt/format.h>

#include "server/storage/stored_report.h"

namespace sheer {

Status status_of(const SQLite::Column& column) {
    const auto status = status_from(column.getString());
    if (!status) throw StoreError("archive: unknown status " + column.getString());
    return *status;
}

std::string document_in(const SQLite::Column& sha256, const SQLite::Column& packed, const std::string& id) {
    const auto* const bytes = static_cast<const char*>(packed.getBlob());
    if (bytes == nullptr) throw DamagedData(fmt::format("the text of report {} is missing", id));
    return stored_report_text({bytes, static_cast<std::size_t>(packed.getBytes())}, sha256.getString(), id);
}

std::optional<JobError> error_of(const SQLite::Column& title, const SQLite::Column& detail) {
    if (title.isNull()) return std::nullopt;
    return JobError{title.getString(), detail.getString()};
}

void end_attempt(SQLite::Database& database, const SqliteArchive& archive, const std::string& id, const JobError& error,
                 Status status) {
    if (status == Status::queued) {
        SQLite::Statement row(database, "SELECT attempts FROM reports WHERE id = ?");
        row.bind(1, id);
        row.executeStep();
        const int attempts = row.getColumn(0).getInt();
        row.reset();
        return requeue(database, id, attempts);
    }
    SQLite::Statement end(database,
                          "UPDATE reports SET status = ?, finished_ms = ?, stage = '', revision = revision + 1, "
                          "lease_owner = NULL, lease_until_ms = NULL, error_title = ?, error_detail = ? WHERE id = ?");
    SQLite::bind(end, std::string(status_text(status)), archive.now_ms());
    if (status == Status::failed) {
        end.bind(3, error.title);
        end.bind(4, error.detail);
    }
    end.bind(5, id);
    end.exec();
    seal_report(database, id);
}

void seal_report(SQLite::Database& database, const std::string& id) {
    SQLite::Statement seal(database,
                           "INSERT OR REPLACE INTO report_seals SELECT report_id, sha256 FROM sealed_reports "
                           "WHERE report_id = ?");
    seal.bind(1, id);
    seal.exec();
}

void requeue(SQLite::Database& database, const std::string& id, int attempts) {
    SQLite::Statement back(database,
                           "UPDATE reports SET status = 'queued', progress = 0, stage = '', revision = revision + 1, "
                           "attempts = ?, lease_owner = NULL, lease_until_ms = NULL WHERE id = ?");
    SQLite::bind(back, attempts, id);
    back.exec();
}

void try_again_what_lacked_room(SQLite::Database& database) {
    database.exec("UPDATE reports SET not_before_ms = 0 WHERE status = 'queued' AND lacks_room <> 0");
}

void write_rendered(SQLite::Database& database, std::int64_t now_ms) {
    SQLite::Statement note(database,
                           "INSERT INTO health VALUES (1, ?1) ON CONFLICT (id) DO UPDATE SET last_rendered_ms = ?1");
    note.bind(1, now_ms);
    note.exec();
}

std::string find_lack_of_room(SQLite::Database& database, SqliteArchive& archive) {
    if (std::string lack = archive.room().lack(); !lack.empty()) return lack;
    SQLite::Statement waiting(database,
                              "SELECT not_before_ms FROM reports WHERE status = 'queued' AND not_before_ms > 0 AND "
                              "not_before_ms > ? AND lacks_room <> 0 ORDER BY not_before_ms LIMIT 1");
    const std::int64_t now_ms = archive.now_ms();
    waiting.bind(1, now_ms);
    if (!waiting.executeStep()) return "";
    return fmt::format("a report did not fit on the archive's disk and will be tried again in {} s",
                       (waiting.getColumn(0).getInt64() - now_ms) / 1000 + 1);
}

std::string lack_of_room_after_tidying(SqliteArchive& archive) {
    if (!archive.room().lack().empty()) archive.checkpoint();
    archive.room().restore_reserve();
    return archive.read([&](SQLite::Database& database) { return find_lack_of_room(database, archive); });
}

}  // namespace sheer
