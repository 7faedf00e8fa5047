#pragma once
#include "server/archive/sqlite_blobs.h"
#include "server/jobs/job_queue.h"

namespace sheer {

// The rows of a report in all tables, inside a transaction.

/// A queued report.
void insert_report(SQLite::Database& database, const NewReport& report, std::int64_t created_ms);
/// Makes it done. The files of its pictures must exist.
void finish_report(SQLite::Database& database, SqliteBlobs& blobs, const std::string& id,
                   const FinishedReport& finished);

}  // namespace sheer
