#pragma once
#include <optional>
#include <string>

#include "server/jobs/job_error.h"
#include "server/jobs/job_queue.h"
#include "server/jobs/status.h"
#include "server/jobs/usage.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

// Steps that several parts of the store do inside their transactions.

/// Throws StoreError for a text that is not a status.
Status status_at(const Rows& rows, int row, int column);
std::optional<JobError> error_at(const Rows& rows, int row, int title_column);

/// The channels that every process listens to: for any change that a reader can see, and for jobs that may be due.
inline constexpr const char* changes_channel = "sheer_changes";
inline constexpr const char* jobs_channel = "sheer_jobs";
/// Takes effect with the commit.
void tell_change(Connection& connection);
void tell_new_job(Connection& connection);

/// Locks the job, so that what this returns stays true.
LeaseState locked_state(Connection& connection, const Lease& lease);
/// Ends an attempt: the job gets a final status or is queued again. `error` is for failed jobs.
void end_attempt(Connection& connection, const std::string& id, const JobError& error, Status status);
/// Those that only this report names.
void remove_pictures(Connection& connection, const std::string& id);
/// Without `attempts`, they stay.
void requeue(Connection& connection, const std::string& id, std::optional<int> attempts);
/// Call it after room was made.
void try_again_what_lacked_room(Connection& connection);
/// Why no report could be stored at present; empty if there is room.
std::string find_lack_of_room(Connection& connection);
void note_rendered(Connection& connection);
void count_lost_lease(Connection& connection);
/// Adds the time of a job to the seconds of its stage's kind, and to those of its token.
void count_stage_time(Connection& connection, const std::string& id, const std::string& stage, double seconds);
/// The same with the time since the job's last heartbeat. Call it before the job's end is written.
void count_last_stage(Connection& connection, const LeaseRules& rules, const std::string& id);
/// Adds to what the token took up in this hour.
void add_use(Connection& connection, const std::string& token, double seconds, std::int64_t upload_bytes);
TokenUse use_of(Connection& connection, const std::string& token);

}  // namespace sheer::postgres
