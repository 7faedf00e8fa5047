#include "server/postgres/postgres_queue.h"

#include <algorithm>

#include "server/postgres/postgres_parts.h"
#include "server/postgres/postgres_steps.h"
#include "server/postgres/report_rows.h"

namespace sheer::postgres {

namespace {

const JobError worker_died{"Rendering failed", "The worker died while it rendered this report."};

std::optional<SubmitResult> result_of_key(Connection& connection, const IdempotencyKey& key) {
    using Outcome = SubmitResult::Outcome;
    const Rows known = connection.run("SELECT id, body_sha256 FROM reports WHERE idempotency_key = $1", {key.key});
    if (known.empty()) return std::nullopt;
    const bool same = known.text(0, 1) == key.body_sha256;
    return SubmitResult{same ? Outcome::repeated : Outcome::key_reused, known.text(0, 0)};
}

}  // namespace

SubmitResult PostgresQueue::submit(const NewReport& report, const QueueLimits& limits) {
    using Outcome = SubmitResult::Outcome;
    return m_database.write([&](Connection& connection) -> SubmitResult {
        if (report.idempotency)
            if (auto known = result_of_key(connection, *report.idempotency)) return *known;
        const Rows queued = connection.run(
            "SELECT count(*), coalesce(sum(cost_mpx), 0) FROM (SELECT cost_mpx FROM jobs WHERE status = 'queued' LIMIT "
            "$1) waiting",
            {static_cast<std::int64_t>(limits.jobs)});
        if (!limits.have_place(queued.integer(0, 0), queued.number(0, 1), report.cost_mpx))
            return {Outcome::queue_full, ""};
        if (report.sender)
            if (const auto no = refusal_of(*report.sender, use_of(connection, report.sender->token))) return {*no, ""};
        if (const std::string lack = find_lack_of_room(connection); !lack.empty()) throw StoreFull(lack);
        if (!insert_report(connection, report, std::nullopt)) throw Conflict("the same key came twice at once");
        insert_job(connection, report);
        tell_new_job(connection);
        return {Outcome::created, report.id};
    });
}

std::optional<Lease> PostgresQueue::lease(const std::string& owner, const std::string& label) {
    // Idle workers ask often, so a transaction is begun only if there is something to do.
    const auto [waits, expired] = m_database.read([&](Connection& connection) {
        const Rows row = connection.run(
            "SELECT EXISTS (SELECT FROM jobs WHERE status = 'queued' AND not_before_ms <= now_ms() AND (labels = '{}' "
            "OR $1 = ANY (labels))), "
            "EXISTS (SELECT FROM jobs WHERE status = 'running' AND lease_until_ms < now_ms())",
            {label});
        return std::pair(row.flag(0, 0), row.flag(0, 1));
    });
    if (expired)
        m_database.write([&](Connection& connection) { end_lost_leases(connection, "lease_until_ms < now_ms()", {}); });
    if (!waits && !expired) return std::nullopt;
    return m_database.write([&](Connection& connection) { return take_oldest(connection, owner, label); });
}

std::optional<Lease> PostgresQueue::take_oldest(Connection& connection, const std::string& owner,
                                                const std::string& label) {
    const Rows job = connection.run(
        "UPDATE jobs SET status = 'running', progress = CASE parts WHEN 0 THEN 0 ELSE parts_ended::float8 / (parts + "
        "1) END, stage = '', attempts = attempts + 1, lease_owner = $1, part = CASE WHEN parts > 0 AND labels <> '{}' "
        "THEN $3 ELSE '' END, lease_until_ms = now_ms() + $2, not_before_ms = 0, lacks_room = false, revision = "
        "revision + 1 WHERE report_id = (SELECT report_id FROM jobs WHERE status = 'queued' AND not_before_ms <= "
        "now_ms() AND (labels = '{}' OR $3 = ANY (labels)) ORDER BY report_id LIMIT 1 FOR UPDATE SKIP LOCKED) "
        "RETURNING report_id, attempts, setbacks, part, parts, parts_ended",
        {owner, m_database.rules().lease_ms, label});
    if (job.empty()) return std::nullopt;
    tell_change(connection);
    const Rows report =
        connection.run("SELECT spec, spec_sha256, created_ms FROM reports WHERE id = $1", {job.text(0, 0)});
    return Lease{.id = job.text(0, 0),
                 .owner = owner,
                 .attempt = static_cast<int>(job.integer(0, 1)),
                 .spec = report.text(0, 0),
                 .spec_sha256 = report.text(0, 1),
                 .created_ms = report.integer(0, 2),
                 .setbacks = static_cast<int>(job.integer(0, 2)),
                 .part = job.text(0, 3),
                 .parts = static_cast<int>(job.integer(0, 4)),
                 .parts_ended = static_cast<int>(job.integer(0, 5))};
}

LeaseState PostgresQueue::heartbeat(const Lease& lease, double progress, const std::string& stage) {
    // A heartbeat that is forgotten ends the lease a second earlier.
    return m_database.write_lightly([&](Connection& connection) {
        const Rows before = connection.run(
            "SELECT cancel_requested, stage, greatest(now_ms() - lease_until_ms + $4, 0), progress <> $5 OR stage <> "
            "$6 "
            "FROM jobs WHERE report_id = $1 AND status = 'running' AND lease_owner = $2 AND attempts = $3 AND "
            "parts_ended = $7 FOR UPDATE",
            {lease.id, lease.owner, std::int64_t{lease.attempt}, m_database.rules().lease_ms,
             std::clamp(progress, 0.0, 1.0), stage, std::int64_t{lease.parts_ended}});
        if (before.empty()) return LeaseState::lost;
        connection.run(
            "UPDATE jobs SET lease_until_ms = now_ms() + $2, revision = revision + $3, progress = $4, stage = $5 WHERE "
            "report_id = $1",
            {lease.id, m_database.rules().lease_ms, std::int64_t{before.flag(0, 3) ? 1 : 0},
             std::clamp(progress, 0.0, 1.0), stage});
        count_stage_time(connection, lease.id, before.text(0, 1), static_cast<double>(before.integer(0, 2)) / 1000);
        if (before.flag(0, 3)) tell_change(connection);
        return before.flag(0, 0) ? LeaseState::cancel_requested : LeaseState::held;
    });
}

LeaseState PostgresQueue::state(const Lease& lease) {
    return m_database.read([&](Connection& connection) {
        const Rows row = connection.run(
            "SELECT cancel_requested FROM jobs WHERE report_id = $1 AND status = 'running' AND lease_owner = $2 AND "
            "attempts = $3 AND parts_ended = $4",
            {lease.id, lease.owner, std::int64_t{lease.attempt}, std::int64_t{lease.parts_ended}});
        if (row.empty()) return LeaseState::lost;
        return row.flag(0, 0) ? LeaseState::cancel_requested : LeaseState::held;
    });
}

std::vector<EndedPart> PostgresQueue::ended_parts(const Lease& lease) {
    return m_database.read([&](Connection& connection) { return read_parts(connection, lease.id, true); });
}

bool PostgresQueue::commit(const Lease& lease, const FinishedReport& finished) {
    return m_database.write([&](Connection& connection) {
        // The pictures first, since they take longest: until then the job is not locked, so that it can be cancelled.
        // Nobody sees them before the end of the transaction, and without it they do not stay.
        connection.script("SAVEPOINT without_pictures");
        put_blobs(connection, finished, false);
        const LeaseState state = locked_state(connection, lease);
        if (state == LeaseState::held) {
            count_last_stage(connection, m_database.rules(), lease.id);
            if (lease.part.empty()) {
                finish_report(connection, lease.id, finished);
            } else {
                name_pictures(connection, lease.id, finished.blobs);
                end_part(connection, lease.id, {.label = lease.part, .report = finished.report.dump()});
            }
            note_rendered(connection);
            tell_change(connection);
            return true;
        }
        connection.script("ROLLBACK TO SAVEPOINT without_pictures");
        if (state == LeaseState::cancel_requested && locked_state(connection, lease) != LeaseState::lost)
            end_attempt(connection, lease.id, {}, Status::cancelled);
        return false;
    });
}

void PostgresQueue::fail_by_signal(const Lease& lease, const JobError& error, int signal) {
    m_database.write([&](Connection& connection) {
        const LeaseState state = locked_state(connection, lease);
        if (state == LeaseState::lost) return;
        count_last_stage(connection, m_database.rules(), lease.id);
        const bool again = !connection
                                .run("SELECT FROM reports WHERE spec_sha256 = $1 AND died_of = $2 LIMIT 1",
                                     {lease.spec_sha256, std::int64_t{signal}})
                                .empty();
        connection.run("UPDATE reports SET died_of = $2 WHERE id = $1", {lease.id, std::int64_t{signal}});
        const bool cancelled = state == LeaseState::cancel_requested;
        const Status after = after_lost_attempt(lease.attempt, cancelled, m_database.rules());
        end_attempt_at_part(connection, lease.id, error, again && !cancelled ? Status::failed : after);
    });
}

void PostgresQueue::set_back(const Lease& lease, const JobError& error, bool lacks_room) {
    m_database.write([&](Connection& connection) {
        const LeaseState state = locked_state(connection, lease);
        if (state == LeaseState::lost) return;
        if (state == LeaseState::cancel_requested) return end_attempt(connection, lease.id, {}, Status::cancelled);
        const int setbacks = lease.setbacks + 1;
        if (setbacks > m_database.rules().max_setbacks)
            return end_attempt_at_part(connection, lease.id, error, Status::failed);
        requeue(connection, lease.id, lease.attempt - 1);
        connection.run(
            "UPDATE jobs SET stage = $2, setbacks = $3, not_before_ms = now_ms() + $4, lacks_room = $5 WHERE report_id "
            "= $1",
            {lease.id, "waiting: " + error.detail, std::int64_t{setbacks}, setback_ms(setbacks, m_database.rules()),
             lacks_room});
    });
}

void PostgresQueue::fail(const Lease& lease, const JobError& error, bool retry) {
    m_database.write([&](Connection& connection) {
        const LeaseState state = locked_state(connection, lease);
        if (state == LeaseState::lost) return;
        count_last_stage(connection, m_database.rules(), lease.id);
        const bool cancelled = state == LeaseState::cancel_requested;
        Status status = cancelled ? Status::cancelled : Status::failed;
        if (retry) status = after_lost_attempt(lease.attempt, cancelled, m_database.rules());
        end_attempt_at_part(connection, lease.id, error, status);
    });
}

void PostgresQueue::cancel(const Lease& lease) {
    m_database.write([&](Connection& connection) {
        if (locked_state(connection, lease) == LeaseState::lost) return;
        count_last_stage(connection, m_database.rules(), lease.id);
        end_attempt(connection, lease.id, {}, Status::cancelled);
    });
}

void PostgresQueue::release(const Lease& lease) {
    m_database.write([&](Connection& connection) {
        const LeaseState state = locked_state(connection, lease);
        if (state == LeaseState::held) requeue(connection, lease.id, lease.attempt - 1);
        if (state == LeaseState::cancel_requested) end_attempt(connection, lease.id, {}, Status::cancelled);
    });
}

void PostgresQueue::end_leases_of(const std::string& owner) {
    m_database.write([&](Connection& connection) { end_lost_leases(connection, "lease_owner = $1", {owner}); });
}

void PostgresQueue::end_lost_leases(Connection& connection, const std::string& condition,
                                    const std::vector<Value>& values) {
    const Rows lost =
        connection.run("SELECT report_id, attempts, cancel_requested FROM jobs WHERE status = 'running' AND " +
                           condition + " FOR UPDATE SKIP LOCKED",
                       values);
    for (int i = 0; i < lost.count(); ++i) {
        count_lost_lease(connection);
        end_attempt_at_part(
            connection, lost.text(i, 0), worker_died,
            after_lost_attempt(static_cast<int>(lost.integer(i, 1)), lost.flag(i, 2), m_database.rules()));
    }
}

}  // namespace sheer::postgres
