#include "server/archive/sqlite_parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/archive/sqlite_steps.h"
#include "server/jobs/facets.h"

namespace sheer {

using nlohmann::json;

void insert_job(SQLite::Database& database, const NewReport& report) {
    const json spec = json::parse(report.spec);
    SQLite::Statement job(database,
                          "INSERT INTO jobs (report_id, token, cost_mpx, labels, parts) VALUES (?, ?, ?, ?, ?)");
    SQLite::bind(job, report.id, report.sender ? report.sender->token : std::string(), report.cost_mpx,
                 json(wanted_devices(spec)).dump(), static_cast<std::int64_t>(listed_devices(spec).size()));
    job.exec();
}

void begin_part(SQLite::Database& database, const std::string& label, Lease& lease) {
    SQLite::Statement job(database, "SELECT parts, parts_ended, labels = '[]' FROM jobs WHERE report_id = ?");
    job.bind(1, lease.id);
    if (!job.executeStep()) return;
    lease.parts = job.getColumn(0).getInt();
    lease.parts_ended = job.getColumn(1).getInt();
    const bool all_ended = job.getColumn(2).getInt() != 0;
    job.reset();
    lease.part = lease.parts > 0 && !all_ended ? label : std::string();
    SQLite::Statement begin(database, "UPDATE jobs SET part = ? WHERE report_id = ?");
    SQLite::bind(begin, lease.part, lease.id);
    begin.exec();
}

std::string running_part(SQLite::Database& database, const std::string& id) {
    SQLite::Statement job(database, "SELECT part FROM jobs WHERE report_id = ?");
    job.bind(1, id);
    return job.executeStep() ? job.getColumn(0).getString() : std::string();
}

std::vector<EndedPart> read_parts(SQLite::Database& database, const std::string& id, bool with_texts) {
    std::vector<EndedPart> parts;
    SQLite::Statement rows(database,
                           "SELECT label, error_title, error_detail, sha256, packed FROM parts WHERE report_id = ? "
                           "ORDER BY label");
    rows.bind(1, id);
    while (rows.executeStep()) {
        EndedPart part{.label = rows.getColumn(0).getString(), .error = error_of(rows.getColumn(1), rows.getColumn(2))};
        if (with_texts && !part.error) part.report = document_in(rows.getColumn(3), rows.getColumn(4), id);
        parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<PartState> read_part_states(SQLite::Database& database, const std::string& id, const std::string& spec) {
    SQLite::Statement job(database,
                          "SELECT CASE status WHEN 'running' THEN part ELSE '' END FROM jobs JOIN reports ON id = "
                          "report_id WHERE report_id = ? AND parts > 0");
    job.bind(1, id);
    if (!job.executeStep()) return {};
    const std::string running = job.getColumn(0).getString();
    return part_states(listed_devices(json::parse(spec, nullptr, false)), read_parts(database, id, false), running);
}

void end_part(SQLite::Database& database, const SqliteArchive& archive, const std::string& id, const EndedPart& part) {
    SQLite::Statement ended(database,
                            "INSERT INTO parts VALUES (?1, ?2, CASE WHEN ?3 IS NOT NULL THEN sheer_sha256(?3) END, "
                            "CASE WHEN ?3 IS NOT NULL THEN sheer_pack(?3) END, ?4, ?5)");
    SQLite::bind(ended, id, part.label);
    if (part.error) {
        ended.bind(4, part.error->title);
        ended.bind(5, part.error->detail);
    } else {
        ended.bind(3, part.report);
    }
    ended.exec();
    SQLite::Statement next(database,
                           "UPDATE jobs SET parts_ended = parts_ended + 1, part = '', labels = (SELECT "
                           "json_group_array(value) FROM json_each(labels) WHERE value <> ?2) WHERE report_id = ?1");
    SQLite::bind(next, id, part.label);
    next.exec();
    SQLite::Statement job(database, "SELECT labels = '[]', parts_ended, parts FROM jobs WHERE report_id = ?");
    job.bind(1, id);
    job.executeStep();
    const bool all_ended = job.getColumn(0).getInt() != 0;
    const double progress = parts_progress(job.getColumn(1).getInt(), job.getColumn(2).getInt(), 0);
    job.reset();
    if (all_ended) {
        const std::vector<EndedPart> parts = read_parts(database, id, false);
        if (std::ranges::all_of(parts, [](const EndedPart& one) { return one.error.has_value(); }))
            return end_attempt(database, archive, id, every_part_failed(parts), Status::failed);
    }
    requeue(database, id, 0);
    // What happened on this device says nothing about the next one.
    SQLite::Statement fresh(database, "UPDATE reports SET progress = ?, setbacks = 0, died_of = NULL WHERE id = ?");
    SQLite::bind(fresh, progress, id);
    fresh.exec();
}

void end_attempt_at_part(SQLite::Database& database, const SqliteArchive& archive, const std::string& id,
                         const JobError& error, Status status) {
    const std::string part = status == Status::failed ? running_part(database, id) : std::string();
    if (part.empty()) return end_attempt(database, archive, id, error, status);
    end_part(database, archive, id, {.label = part, .error = error});
}

}  // namespace sheer
