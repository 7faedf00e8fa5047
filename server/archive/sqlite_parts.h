#pragma once
#include <string>
#include <vector>

#include "server/archive/sqlite_archive.h"
#include "server/jobs/job_queue.h"

namespace sheer {

// The parts of reports of several devices: steps inside the transactions of the store.

/// Adds the job of a new report, whose parts wait for the workers of their labels.
void insert_job(SQLite::Database& database, const NewReport& report);
/// What the job's next attempt renders, for a worker with this label; sets the lease's members on parts.
void begin_part(SQLite::Database& database, const std::string& label, Lease& lease);
/// The label of the part that a running job renders; "" if it renders the whole report.
std::string running_part(SQLite::Database& database, const std::string& id);
/// The parts of a report that have ended, by their labels; without their texts unless `with_texts`. Throws DamagedData.
std::vector<EndedPart> read_parts(SQLite::Database& database, const std::string& id, bool with_texts);
/// The states of the parts of a report that has not ended; none if it has no parts.
std::vector<PartState> read_part_states(SQLite::Database& database, const std::string& id, const std::string& spec);
/// Ends the part that the job renders. The job is queued for the next one, or for joining them, or fails if all failed.
void end_part(SQLite::Database& database, const SqliteArchive& archive, const std::string& id, const EndedPart& part);
/// end_attempt(), but where a job would fail while it renders a part, that part ends.
void end_attempt_at_part(SQLite::Database& database, const SqliteArchive& archive, const std::string& id,
                         const JobError& error, Status status);

}  // namespace sheer
