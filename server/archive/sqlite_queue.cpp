#include "server/archive/sqlite_queue.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/archive/report_rows.h"
#include "server/archive/sqlite_activity.h"
#include "server/archive/sqlite_parts.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

namespace {

const JobError worker_died{"Rendering failed", "The worker died while it rendered this report."};

/// The attempts of each part count from 1.
constexpr const char* lease_condition =
    "id = ? AND status = 'running' AND lease_owner = ? AND attempts = ? AND "
    "(SELECT parts_ended FROM jobs WHERE report_id = id) = ?";

/// A job that is due and that a worker may run, with its time and its label as ?1 and ?2.
constexpr const char* due_condition =
    "status = 'queued' AND not_before_ms <= ?1 AND (labels = '[]' OR EXISTS (SELECT 1 FROM json_each(labels) WHERE "
    "value = ?2))";

void bind_lease(SQLite::Statement& statement, int first, const Lease& lease) {
    statement.bind(first, lease.id);
    statement.bind(first + 1, lease.owner);
    statement.bind(first + 2, lease.attempt);
    statement.bind(first + 3, lease.parts_ended);
}

LeaseState read_state(SQLite::Database& database, const Lease& lease) {
    SQLite::Statement row(database, fmt::format("SELECT cancel_requested FROM reports WHERE {}", lease_condition));
    bind_lease(row, 1, lease);
    if (!row.executeStep()) return LeaseState::lost;
    return row.getColumn(0).getInt() != 0 ? LeaseState::cancel_requested : LeaseState::held;
}

}  // namespace

SubmitResult SqliteQueue::submit(const NewReport& report, const QueueLimits& limits) {
    using Outcome = SubmitResult::Outcome;
    m_archive.room().restore_reserve();
    return m_archive.write([&](SQLite::Database& database) -> SubmitResult {
        if (report.idempotency) {
            SQLite::Statement known(database, "SELECT id, body_sha256 FROM reports WHERE idempotency_key = ?");
            known.bind(1, report.idempotency->key);
            if (known.executeStep()) {
                const bool same = known.getColumn(1).getString() == report.idempotency->body_sha256;
                return {same ? Outcome::repeated : Outcome::key_reused, known.getColumn(0).getString()};
            }
        }
        SQLite::Statement queued(
            database,
            "SELECT count(*), total(cost_mpx) FROM reports JOIN jobs ON report_id = id WHERE status "
            "= 'queued'");
        queued.executeStep();
        if (!limits.have_place(queued.getColumn(0).getInt64(), queued.getColumn(1).getDouble(), report.cost_mpx))
            return {Outcome::queue_full, ""};
        if (report.sender)
            if (const auto no = refusal_of(*report.sender, use_of(database, m_archive.now_ms(), report.sender->token)))
                return {*no, ""};
        if (const std::string lack = find_lack_of_room(database, m_archive); !lack.empty()) throw StoreFull(lack);
        insert_report(database, report, m_archive.now_ms());
        return {Outcome::created, report.id};
    });
}

std::optional<Lease> SqliteQueue::lease(const std::string& owner, const std::string& label) {
    m_archive.finish_checkpoint();
    if (!m_archive.room().lack().empty()) return std::nullopt;
    // Idle workers ask often, so the write lock is taken only if there is something to do.
    const bool anything = m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement row(
            database, fmt::format("SELECT EXISTS (SELECT 1 FROM reports JOIN jobs ON report_id = id WHERE {}) OR "
                                  "EXISTS (SELECT 1 FROM reports WHERE status = 'running' AND lease_until_ms < ?1)",
                                  due_condition));
        SQLite::bind(row, m_archive.now_ms(), label);
        return row.executeStep() && row.getColumn(0).getInt() != 0;
    });
    if (!anything) return std::nullopt;
    std::vector<std::string> lost;
    const auto leased = m_archive.write([&](SQLite::Database& database) -> std::optional<Lease> {
        const std::int64_t now_ms = m_archive.now_ms();
        lost = end_lost_leases(database, "lease_until_ms < cast(? AS INTEGER)", std::to_string(now_ms));
        SQLite::Statement next(
            database,
            fmt::format("SELECT id, attempts, spec, spec_sha256, created_ms, setbacks FROM reports JOIN jobs ON "
                        "report_id = id WHERE {} ORDER BY id LIMIT 1",
                        due_condition));
        SQLite::bind(next, now_ms, label);
        if (!next.executeStep()) return std::nullopt;
        Lease lease{.id = next.getColumn(0).getString(),
                    .owner = owner,
                    .attempt = next.getColumn(1).getInt() + 1,
                    .spec = next.getColumn(2).getString(),
                    .spec_sha256 = next.getColumn(3).getString(),
                    .created_ms = next.getColumn(4).getInt64(),
                    .setbacks = next.getColumn(5).getInt()};
        next.reset();
        begin_part(database, label, lease);
        SQLite::Statement take(database,
                               "UPDATE reports SET status = 'running', progress = ?, stage = '', attempts = ?, "
                               "lease_owner = ?, lease_until_ms = ?, not_before_ms = 0, lacks_room = 0, revision = "
                               "revision + 1 WHERE id = ?");
        SQLite::bind(take, parts_progress(lease.parts_ended, lease.parts, 0), lease.attempt, owner,
                     now_ms + m_archive.rules().lease_ms, lease.id);
        take.exec();
        return lease;
    });
    for (const std::string& id : lost) m_blobs.remove_of_parts(id);
    return leased;
}

LeaseState SqliteQueue::heartbeat(const Lease& lease, double progress, const std::string& stage) {
    return m_archive.write([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::lost) return state;
        count_stage_time(database, m_archive, lease.id);
        SQLite::Statement renew(
            database,
            "UPDATE reports SET lease_until_ms = ?1, revision = revision + (progress <> ?2 OR stage "
            "<> ?3), progress = ?2, stage = ?3 WHERE id = ?4");
        SQLite::bind(renew, m_archive.now_ms() + m_archive.rules().lease_ms, std::clamp(progress, 0.0, 1.0), stage,
                     lease.id);
        renew.exec();
        return state;
    });
}

LeaseState SqliteQueue::state(const Lease& lease) {
    return m_archive.read([&](SQLite::Database& database) { return read_state(database, lease); });
}

std::vector<EndedPart> SqliteQueue::ended_parts(const Lease& lease) {
    return m_archive.read([&](SQLite::Database& database) { return read_parts(database, lease.id, true); });
}

bool SqliteQueue::commit(const Lease& lease, const FinishedReport& finished) {
    std::vector<std::string> added;
    bool kept = false;
    try {
        for (const BlobName& blob : finished.blobs) put_blob(finished, blob, added);
        kept = commit_rows(lease, finished, added);
    } catch (const std::exception&) {
        m_blobs.remove_unnamed_files(added);
        throw;
    }
    if (!kept) m_blobs.remove_unnamed_files(added);
    if (!kept) m_blobs.remove_of_parts(lease.id);
    m_archive.checkpoint();
    return kept;
}

bool SqliteQueue::commit_rows(const Lease& lease, const FinishedReport& finished, std::vector<std::string>& added) {
    return m_archive.write([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::cancel_requested) end_attempt(database, m_archive, lease.id, {}, Status::cancelled);
        if (state != LeaseState::held) return false;
        count_stage_time(database, m_archive, lease.id);
        // Before the write lock was held, a deletion may have removed a file that another report shared with this one.
        for (const BlobName& blob : finished.blobs)
            if (!m_archive.blobs().find(blob.sha256)) put_blob(finished, blob, added);
        if (lease.part.empty()) {
            finish_report(database, m_blobs, lease.id, finished);
        } else {
            for (const BlobName& blob : finished.blobs) m_blobs.add(database, lease.id, blob);
            end_part(database, m_archive, lease.id, {.label = lease.part, .report = finished.report.dump()});
        }
        write_rendered(database, m_archive.now_ms());
        return true;
    });
}

void SqliteQueue::put_blob(const FinishedReport& finished, const BlobName& blob, std::vector<std::string>& added) {
    if (m_archive.blobs().put(blob.sha256, finished.read_blob(blob.sha256))) added.push_back(blob.sha256);
}

void SqliteQueue::fail_by_signal(const Lease& lease, const JobError& error, int signal) {
    m_archive.essential([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::lost) return;
        count_stage_time(database, m_archive, lease.id);
        SQLite::Statement known(database, "SELECT 1 FROM reports WHERE spec_sha256 = ? AND died_of = ?");
        SQLite::bind(known, lease.spec_sha256, signal);
        const bool again = known.executeStep();
        known.reset();
        SQLite::Statement note(database, "UPDATE reports SET died_of = ? WHERE id = ?");
        SQLite::bind(note, signal, lease.id);
        note.exec();
        const bool cancelled = state == LeaseState::cancel_requested;
        const Status after = after_lost_attempt(lease.attempt, cancelled, m_archive.rules());
        end_attempt_at_part(database, m_archive, lease.id, error, again && !cancelled ? Status::failed : after);
    });
    m_blobs.remove_of_parts(lease.id);
    m_archive.checkpoint();
}

void SqliteQueue::set_back(const Lease& lease, const JobError& error, bool lacks_room) {
    m_archive.essential([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::lost) return;
        if (state == LeaseState::cancel_requested)
            return end_attempt(database, m_archive, lease.id, {}, Status::cancelled);
        const int setbacks = lease.setbacks + 1;
        if (setbacks > m_archive.rules().max_setbacks)
            return end_attempt_at_part(database, m_archive, lease.id, error, Status::failed);
        requeue(database, lease.id, lease.attempt - 1);
        SQLite::Statement wait(
            database, "UPDATE reports SET stage = ?, setbacks = ?, not_before_ms = ?, lacks_room = ? WHERE id = ?");
        SQLite::bind(wait, "waiting: " + error.detail, setbacks,
                     m_archive.now_ms() + setback_ms(setbacks, m_archive.rules()), lacks_room ? 1 : 0, lease.id);
        wait.exec();
    });
    m_blobs.remove_of_parts(lease.id);
    m_archive.checkpoint();
}

void SqliteQueue::fail(const Lease& lease, const JobError& error, bool retry) {
    m_archive.essential([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::lost) return;
        count_stage_time(database, m_archive, lease.id);
        const bool cancelled = state == LeaseState::cancel_requested;
        Status status = cancelled ? Status::cancelled : Status::failed;
        if (retry) status = after_lost_attempt(lease.attempt, cancelled, m_archive.rules());
        end_attempt_at_part(database, m_archive, lease.id, error, status);
    });
    m_blobs.remove_of_parts(lease.id);
    m_archive.checkpoint();
}

void SqliteQueue::cancel(const Lease& lease) {
    m_archive.essential([&](SQLite::Database& database) {
        if (read_state(database, lease) == LeaseState::lost) return;
        count_stage_time(database, m_archive, lease.id);
        end_attempt(database, m_archive, lease.id, {}, Status::cancelled);
    });
    m_blobs.remove_of_parts(lease.id);
    m_archive.checkpoint();
}

void SqliteQueue::release(const Lease& lease) {
    m_archive.essential([&](SQLite::Database& database) {
        const LeaseState state = read_state(database, lease);
        if (state == LeaseState::held) requeue(database, lease.id, lease.attempt - 1);
        if (state == LeaseState::cancel_requested) end_attempt(database, m_archive, lease.id, {}, Status::cancelled);
    });
    m_blobs.remove_of_parts(lease.id);
}

void SqliteQueue::end_leases_of(const std::string& owner) {
    const auto lost = m_archive.essential(
        [&](SQLite::Database& database) { return end_lost_leases(database, "lease_owner = ?", owner); });
    for (const std::string& id : lost) m_blobs.remove_of_parts(id);
}

std::vector<std::string> SqliteQueue::end_lost_leases(SQLite::Database& database, const std::string& condition,
                                                      const std::string& value) {
    struct Lost {
        std::string id;
        int attempts;
        bool cancel_requested;
    };
    std::vector<Lost> all;
    SQLite::Statement rows(
        database, "SELECT id, attempts, cancel_requested FROM reports WHERE status = 'running' AND " + condition);
    rows.bind(1, value);
    while (rows.executeStep())
        all.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getInt(), rows.getColumn(2).getInt() != 0});
    rows.reset();
    std::vector<std::string> ids;
    for (const Lost& lost : all) {
        count_lost_lease(database);
        end_attempt_at_part(database, m_archive, lost.id, worker_died,
                            after_lost_attempt(lost.attempts, lost.cancel_requested, m_archive.rules()));
        ids.push_back(lost.id);
    }
    return ids;
}

}  // namespace sheer
