#pragma once
#include <optional>
#include <string>

#include "server/archive/sqlite_archive.h"
#include "server/jobs/job_error.h"
#include "server/jobs/status.h"

namespace sheer {

// Steps that several parts of the store do inside their transactions.

/// Throws StoreError for a text that is not a status.
Status status_of(const SQLite::Column& column);
/// The text of the done report `id`. Throws DamagedData if it cannot be read or has another hash.
std::string document_in(const SQLite::Column& sha256, const SQLite::Column& packed, const std::string& id);
std::optional<JobError> error_of(const SQLite::Column& title, const SQLite::Column& detail);

/// Ends an attempt: the job gets a final status or is queued again. `error` is for failed jobs.
void end_attempt(SQLite::Database& database, const SqliteArchive& archive, const std::string& id, const JobError& error,
                 Status status);
/// Call it when a report has become final.
void seal_report(SQLite::Database& database, const std::string& id);
void requeue(SQLite::Database& database, const std::string& id, int attempts);
/// Call it after room was made.
void try_again_what_lacked_room(SQLite::Database& database);
void write_rendered(SQLite::Database& database, std::int64_t now_ms);
/// Why no report could be stored at present; empty if there is room.
std::string find_lack_of_room(SQLite::Database& database, SqliteArchive& archive);

/// The same outside of a transaction, after trying to make room.
std::string lack_of_room_after_tidying(SqliteArchive& archive);

}  // namespace sheer
