#pragma once
#include <string>
#include <vector>

#include "server/jobs/job_queue.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

// The parts of reports of several devices: steps inside the transactions of the store.

/// Adds the job of a new report, whose parts wait for the workers of their labels.
void insert_job(Connection& connection, const NewReport& report);
/// The parts of a report that have ended, by their labels; without their texts unless `with_texts`. Throws DamagedData.
std::vector<EndedPart> read_parts(Connection& connection, const std::string& id, bool with_texts);
/// The states of the parts of a report that has not ended; none if it has no parts.
std::vector<PartState> read_part_states(Connection& connection, const std::string& id, const std::string& spec);
/// Ends the part that the job renders. The job is queued for the next one, or for joining them, or fails if all failed.
void end_part(Connection& connection, const std::string& id, const EndedPart& part);
/// end_attempt(), but where a job would fail while it renders a part, that part ends.
void end_attempt_at_part(Connection& connection, const std::string& id, const JobError& error, Status status);

}  // namespace sheer::postgres
