#include "server/postgres/postgres_parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/core/sha256.h"
#include "server/jobs/facets.h"
#include "server/postgres/postgres_steps.h"
#include "server/storage/packed_text.h"
#include "server/storage/stored_report.h"

namespace sheer::postgres {

using nlohmann::json;

void insert_job(Connection& connection, const NewReport& report) {
    const json spec = json::parse(report.spec);
    connection.run("INSERT INTO jobs (report_id, labels, parts, token, cost_mpx) VALUES ($1, $2, $3, $4, $5)",
                   {report.id, wanted_devices(spec), static_cast<std::int64_t>(listed_devices(spec).size()),
                    report.sender ? report.sender->token : std::string(), report.cost_mpx});
}

std::vector<EndedPart> read_parts(Connection& connection, const std::string& id, bool with_texts) {
    const Rows rows = connection.run(
        with_texts ? "SELECT label, error_title, error_detail, sha256, packed FROM parts WHERE report_id = $1 ORDER BY "
                     "label"
                   : "SELECT label, error_title, error_detail FROM parts WHERE report_id = $1 ORDER BY label",
        {id});
    std::vector<EndedPart> parts;
    for (int i = 0; i < rows.count(); ++i) {
        EndedPart part{.label = rows.text(i, 0), .error = error_at(rows, i, 1)};
        if (with_texts && !part.error) part.report = stored_report_text(rows.bytes(i, 4), rows.text(i, 3), id);
        parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<PartState> read_part_states(Connection& connection, const std::string& id, const std::string& spec) {
    const Rows job = connection.run(
        "SELECT CASE status WHEN 'running' THEN part ELSE '' END FROM jobs WHERE report_id = $1 AND parts > 0", {id});
    if (job.empty()) return {};
    return part_states(listed_devices(json::parse(spec, nullptr, false)), read_parts(connection, id, false),
                       job.text(0, 0));
}

void end_part(Connection& connection, const std::string& id, const EndedPart& part) {
    if (part.error) {
        connection.run("INSERT INTO parts (report_id, label, error_title, error_detail) VALUES ($1, $2, $3, $4)",
                       {id, part.label, part.error->title, part.error->detail});
    } else {
        const std::string packed = pack_text(part.report);
        connection.run("INSERT INTO parts (report_id, label, sha256, packed) VALUES ($1, $2, $3, $4)",
                       {id, part.label, sha256_hex(part.report), Bytes{packed}});
    }
    const Rows job = connection.run(
        "UPDATE jobs SET parts_ended = parts_ended + 1, part = '', labels = array_remove(labels, $2) WHERE report_id = "
        "$1 RETURNING labels = '{}', parts_ended, parts",
        {id, part.label});
    if (job.flag(0, 0)) {
        const std::vector<EndedPart> parts = read_parts(connection, id, false);
        if (std::ranges::all_of(parts, [](const EndedPart& one) { return one.error.has_value(); }))
            return end_attempt(connection, id, every_part_failed(parts), Status::failed);
    }
    requeue(connection, id, 0);
    // What happened on this device says nothing about the next one.
    const int ended = static_cast<int>(job.integer(0, 1)), all = static_cast<int>(job.integer(0, 2));
    connection.run("UPDATE jobs SET progress = $2, setbacks = 0 WHERE report_id = $1",
                   {id, parts_progress(ended, all, 0)});
    connection.run("UPDATE reports SET died_of = NULL WHERE id = $1 AND died_of IS NOT NULL", {id});
}

void end_attempt_at_part(Connection& connection, const std::string& id, const JobError& error, Status status) {
    if (status == Status::failed) {
        const Rows job = connection.run("SELECT part FROM jobs WHERE report_id = $1 AND part <> ''", {id});
        if (!job.empty()) return end_part(connection, id, {.label = job.text(0, 0), .error = error});
    }
    end_attempt(connection, id, error, status);
}

}  // namespace sheer::postgres
