#include "server/postgres/postgres_steps.h"

#include <fmt/format.h>

#include "server/jobs/activity.h"
#include "server/postgres/counter_names.h"

namespace sheer::postgres {

namespace {

/// Rows that are added to are split in so many parts; see schema.sql.
constexpr const char* part = "pg_backend_pid() % 64";

void add_to_counter(Connection& connection, const std::string& name, double value) {
    connection.run(
        fmt::format("INSERT INTO counters VALUES ($1, {}, $2) ON CONFLICT (name, part) DO UPDATE SET value = "
                    "counters.value + excluded.value",
                    part),
        {name, value});
}

}  // namespace

Status status_at(const Rows& rows, int row, int column) {
    const auto status = status_from(rows.text(row, column));
    if (!status) throw StoreError("database: unknown status " + rows.text(row, column));
    return *status;
}

std::optional<JobError> error_at(const Rows& rows, int row, int title_column) {
    if (rows.is_null(row, title_column)) return std::nullopt;
    return JobError{rows.text(row, title_column), rows.text(row, title_column + 1)};
}

void tell_change(Connection& connection) {
    connection.script(fmt::format("NOTIFY {}", changes_channel));
}

void tell_new_job(Connection& connection) {
    connection.script(fmt::format("NOTIFY {}; NOTIFY {}", jobs_channel, changes_channel));
}

LeaseState locked_state(Connection& connection, const Lease& lease) {
    const Rows row = connection.run(
        "SELECT cancel_requested FROM jobs WHERE report_id = $1 AND status = 'running' AND lease_owner = $2 AND "
        "attempts = $3 AND parts_ended = $4 FOR UPDATE",
        {lease.id, lease.owner, std::int64_t{lease.attempt}, std::int64_t{lease.parts_ended}});
    if (row.empty()) return LeaseState::lost;
    return row.flag(0, 0) ? LeaseState::cancel_requested : LeaseState::held;
}

void end_attempt(Connection& connection, const std::string& id, const JobError& error, Status status) {
    if (status == Status::queued) return requeue(connection, id, std::nullopt);
    const bool failed = status == Status::failed;
    connection.run(
        "WITH job AS (DELETE FROM jobs WHERE report_id = $1 RETURNING progress, revision) UPDATE reports SET status = "
        "$2, "
        "finished_ms = now_ms(), progress = job.progress, revision = job.revision + 1, error_title = $3, error_detail "
        "= $4 "
        "FROM job WHERE id = $1",
        {id, std::string(status_text(status)), failed ? Value(error.title) : Value(nullptr),
         failed ? Value(error.detail) : Value(nullptr)});
    connection.run("DELETE FROM parts WHERE report_id = $1", {id});
    remove_pictures(connection, id);
    tell_change(connection);
}

void remove_pictures(Connection& connection, const std::string& id) {
    // A report that is being committed may name one of them: once they are locked, it either does already or has to
    // store it again.
    const Rows pictures = connection.run(
        "SELECT sha256 FROM blobs WHERE sha256 IN (SELECT sha256 FROM report_blobs WHERE report_id = $1) ORDER BY "
        "sha256 FOR UPDATE",
        {id});
    if (pictures.empty()) return;
    connection.run("DELETE FROM report_blobs WHERE report_id = $1", {id});
    std::vector<std::string> names;
    for (int i = 0; i < pictures.count(); ++i) names.push_back(pictures.text(i, 0));
    connection.run(
        "DELETE FROM blobs b WHERE sha256 = ANY ($1) AND NOT EXISTS (SELECT FROM report_blobs r WHERE r.sha256 = "
        "b.sha256)",
        {names});
}

void requeue(Connection& connection, const std::string& id, std::optional<int> attempts) {
    connection.run(
        "UPDATE jobs SET status = 'queued', progress = 0, stage = '', revision = revision + 1, attempts = coalesce($2, "
        "attempts), lease_owner = NULL, lease_until_ms = NULL WHERE report_id = $1",
        {id, attempts ? Value(std::int64_t{*attempts}) : Value(nullptr)});
    tell_new_job(connection);
}

void try_again_what_lacked_room(Connection& connection) {
    const Rows due = connection.run("UPDATE jobs SET not_before_ms = 0 WHERE status = 'queued' AND lacks_room");
    if (due.changed() > 0) tell_new_job(connection);
}

std::string find_lack_of_room(Connection& connection) {
    const Rows waiting = connection.run(
        "SELECT not_before_ms - now_ms() FROM jobs WHERE status = 'queued' AND lacks_room AND not_before_ms > now_ms() "
        "ORDER BY not_before_ms LIMIT 1");
    if (waiting.empty()) return "";
    return fmt::format("a report did not fit on a disk and will be tried again in {} s",
                       waiting.integer(0, 0) / 1000 + 1);
}

void note_rendered(Connection& connection) {
    connection.run(
        fmt::format("INSERT INTO health VALUES ({}, now_ms()) ON CONFLICT (part) DO UPDATE SET "
                    "last_rendered_ms = excluded.last_rendered_ms",
                    part));
}

void count_lost_lease(Connection& connection) {
    add_to_counter(connection, lost_leases_counter, 1);
}

void count_stage_time(Connection& connection, const std::string& id, const std::string& stage, double seconds) {
    const std::string kind = kind_of_stage(stage);
    add_to_counter(connection, stage_counter_prefix + (kind.empty() ? "starting" : kind), seconds);
    const Rows sender = connection.run("SELECT token FROM jobs WHERE report_id = $1 AND token <> ''", {id});
    if (!sender.empty()) add_use(connection, sender.text(0, 0), seconds, 0);
}

void count_last_stage(Connection& connection, const LeaseRules& rules, const std::string& id) {
    const Rows job = connection.run(
        "SELECT stage, greatest(now_ms() - lease_until_ms + $2, 0) FROM jobs WHERE report_id = $1 AND lease_until_ms "
        "IS "
        "NOT NULL",
        {id, rules.lease_ms});
    if (!job.empty()) count_stage_time(connection, id, job.text(0, 0), static_cast<double>(job.integer(0, 1)) / 1000);
}

void add_use(Connection& connection, const std::string& token, double seconds, std::int64_t upload_bytes) {
    connection.run(
        fmt::format("INSERT INTO token_use VALUES ($1, now_ms() / $2, {}, $3, $4) ON CONFLICT (token, hour, part) DO "
                    "UPDATE SET seconds = token_use.seconds + excluded.seconds, upload_bytes = token_use.upload_bytes "
                    "+ excluded.upload_bytes",
                    part),
        {token, use_hour_ms, seconds, upload_bytes});
    connection.run(
        "DELETE FROM token_use WHERE (token, hour, part) IN (SELECT token, hour, part FROM token_use WHERE hour <= "
        "now_ms() / $1 - $2 FOR UPDATE SKIP LOCKED)",
        {use_hour_ms, use_hours});
}

TokenUse use_of(Connection& connection, const std::string& token) {
    TokenUse use;
    const Rows jobs = connection.run("SELECT count(*) FROM jobs WHERE token = $1", {token});
    use.jobs = jobs.integer(0, 0);
    const Rows day = connection.run(
        "SELECT sum(seconds), sum(upload_bytes)::bigint, min(hour) FROM token_use WHERE token = $1 AND hour > now_ms() "
        "/ $2 - $3",
        {token, use_hour_ms, use_hours});
    if (day.is_null(0, 2)) return use;
    use.seconds = day.number(0, 0);
    use.upload_bytes = day.integer(0, 1);
    use.less_at_ms = (day.integer(0, 2) + use_hours) * use_hour_ms;
    return use;
}

}  // namespace sheer::postgres
