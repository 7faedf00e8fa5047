#include <fmt/format.h>

#include <algorithm>

#include "server/archive/sqlite_guard.h"
#include "server/archive/sqlite_store.h"
#include "server/jobs/facets.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::uintmax_t max_blob_bytes = std::uintmax_t{512} << 20;

const JobError worker_died{"Rendering failed", "The worker died while it rendered this report."};

constexpr const char* lease_condition = "id = ? AND status = 'running' AND lease_owner = ? AND attempts = ?";

void bind_lease(SQLite::Statement& statement, int first, const Lease& lease) {
    statement.bind(first, lease.id);
    statement.bind(first + 1, lease.owner);
    statement.bind(first + 2, lease.attempt);
}

LeaseState read_state(SQLite::Database& database, const Lease& lease) {
    SQLite::Statement row(database, fmt::format("SELECT cancel_requested FROM reports WHERE {}", lease_condition));
    bind_lease(row, 1, lease);
    if (!row.executeStep()) return LeaseState::lost;
    return row.getColumn(0).getInt() != 0 ? LeaseState::cancel_requested : LeaseState::held;
}

}  // namespace

std::optional<Lease> SqliteStore::lease(const std::string& owner) {
    if (m_checkpoint_due) checkpoint();
    if (!m_room.lack().empty()) return std::nullopt;
    // Idle workers ask often, so the write lock is taken only when there is something to do.
    const bool anything = guarded(m_mutex, [&] {
        SQLite::Statement row(
            m_database,
            "SELECT EXISTS (SELECT 1 FROM reports WHERE status = 'queued' AND not_before_ms <= ?1) OR "
            "EXISTS (SELECT 1 FROM reports WHERE status = 'running' AND lease_until_ms < ?1)");
        row.bind(1, m_clock());
        return row.executeStep() && row.getColumn(0).getInt() != 0;
    });
    if (!anything) return std::nullopt;
    return transacted(m_mutex, m_database, [&]() -> std::optional<Lease> {
        const std::int64_t now_ms = m_clock();
        end_lost_leases("lease_until_ms < cast(? AS INTEGER)", std::to_string(now_ms));
        SQLite::Statement next(
            m_database,
            "SELECT id, attempts, spec, spec_sha256, created_ms, setbacks FROM reports WHERE status = 'queued' AND "
            "not_before_ms <= ? ORDER BY id LIMIT 1");
        next.bind(1, now_ms);
        if (!next.executeStep()) return std::nullopt;
        Lease lease{.id = next.getColumn(0).getString(),
                    .owner = owner,
                    .attempt = next.getColumn(1).getInt() + 1,
                    .spec = next.getColumn(2).getString(),
                    .spec_sha256 = next.getColumn(3).getString(),
                    .created_ms = next.getColumn(4).getInt64(),
                    .setbacks = next.getColumn(5).getInt()};
        next.reset();
        SQLite::Statement take(m_database,
                               "UPDATE reports SET status = 'running', progress = 0, stage = '', attempts = ?, "
                               "lease_owner = ?, lease_until_ms = ?, not_before_ms = 0, lacks_room = 0, revision = "
                               "revision + 1 WHERE id = ?");
        SQLite::bind(take, lease.attempt, owner, now_ms + m_rules.lease_ms, lease.id);
        take.exec();
        return lease;
    });
}

LeaseState SqliteStore::heartbeat(const Lease& lease, double progress, const std::string& stage) {
    return transacted(m_mutex, m_database, [&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::lost) return state;
        SQLite::Statement renew(
            m_database,
            "UPDATE reports SET lease_until_ms = ?1, revision = revision + (progress <> ?2 OR stage "
            "<> ?3), progress = ?2, stage = ?3 WHERE id = ?4");
        SQLite::bind(renew, m_clock() + m_rules.lease_ms, std::clamp(progress, 0.0, 1.0), stage, lease.id);
        renew.exec();
        return state;
    });
}

LeaseState SqliteStore::state(const Lease& lease) {
    return guarded(m_mutex, [&] { return read_state(m_database, lease); });
}

bool SqliteStore::commit(const Lease& lease, const FinishedReport& finished) {
    std::vector<std::string> added;
    bool kept = false;
    try {
        put_blobs(finished.blobs, added);
        kept = commit_rows(lease, finished, added);
    } catch (const std::exception&) {
        remove_unnamed_files(added);
        throw;
    }
    if (!kept) remove_unnamed_files(added);
    checkpoint();
    return kept;
}

bool SqliteStore::commit_rows(const Lease& lease, const FinishedReport& finished, std::vector<std::string>& added) {
    return transacted(m_mutex, m_database, [&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::cancel_requested) end_attempt(lease.id, {}, Status::cancelled);
        if (state != LeaseState::held) return false;
        // Between put_blobs and the write lock a deletion may have taken a file that both reports name.
        for (const BlobFile& blob : finished.blobs)
            if (!m_blobs.find(blob.sha256)) put_blobs({blob}, added);
        SQLite::Statement done(
            m_database,
            "UPDATE reports SET status = 'done', progress = 1, stage = '', revision = revision + 1, "
            "died_of = NULL, finished_ms = ?, verdict = ?, preview = ?, report = ?, lease_owner = NULL, "
            "lease_until_ms = NULL WHERE id = ?");
        const json preview = preview_of(finished.report);
        SQLite::bind(done, finished.finished_ms, finished.report.value("verdict", ""));
        if (!preview.is_null()) done.bind(3, preview.dump());
        done.bind(4, finished.report.dump());
        done.bind(5, lease.id);
        done.exec();
        for (const BlobFile& blob : finished.blobs) {
            SQLite::Statement keep(m_database, "INSERT INTO blobs VALUES (?, ?) ON CONFLICT DO NOTHING");
            SQLite::bind(keep, blob.sha256, blob.media_type);
            keep.exec();
            SQLite::Statement name(m_database, "INSERT INTO report_blobs VALUES (?, ?) ON CONFLICT DO NOTHING");
            SQLite::bind(name, lease.id, blob.sha256);
            name.exec();
        }
        write_rendered();
        return true;
    });
}

void SqliteStore::put_blobs(const std::vector<BlobFile>& blobs, std::vector<std::string>& added) {
    for (const BlobFile& blob : blobs)
        if (m_blobs.put(blob.sha256, read_file(blob.path, max_blob_bytes))) added.push_back(blob.sha256);
}

void SqliteStore::fail_by_signal(const Lease& lease, const JobError& error, int signal) {
    essential([&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::lost) return;
        SQLite::Statement known(m_database, "SELECT 1 FROM reports WHERE spec_sha256 = ? AND died_of = ?");
        SQLite::bind(known, lease.spec_sha256, signal);
        const bool again = known.executeStep();
        known.reset();
        SQLite::Statement note(m_database, "UPDATE reports SET died_of = ? WHERE id = ?");
        SQLite::bind(note, signal, lease.id);
        note.exec();
        const bool cancelled = state == LeaseState::cancel_requested;
        const Status after = after_lost_attempt(lease.attempt, cancelled, m_rules);
        end_attempt(lease.id, error, again && !cancelled ? Status::failed : after);
    });
    checkpoint();
}

void SqliteStore::set_back(const Lease& lease, const JobError& error, bool lacks_room) {
    essential([&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::lost) return;
        if (state == LeaseState::cancel_requested) return end_attempt(lease.id, {}, Status::cancelled);
        const int setbacks = lease.setbacks + 1;
        if (setbacks > m_rules.max_setbacks) return end_attempt(lease.id, error, Status::failed);
        requeue(lease.id, lease.attempt - 1);
        SQLite::Statement wait(
            m_database, "UPDATE reports SET stage = ?, setbacks = ?, not_before_ms = ?, lacks_room = ? WHERE id = ?");
        SQLite::bind(wait, "waits: " + error.detail, setbacks, m_clock() + setback_ms(setbacks, m_rules),
                     lacks_room ? 1 : 0, lease.id);
        wait.exec();
    });
    checkpoint();
}

void SqliteStore::fail(const Lease& lease, const JobError& error, bool retry) {
    essential([&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::lost) return;
        const bool cancelled = state == LeaseState::cancel_requested;
        Status status = cancelled ? Status::cancelled : Status::failed;
        if (retry) status = after_lost_attempt(lease.attempt, cancelled, m_rules);
        end_attempt(lease.id, error, status);
    });
    checkpoint();
}

void SqliteStore::cancel(const Lease& lease) {
    essential([&] {
        if (read_state(m_database, lease) != LeaseState::lost) end_attempt(lease.id, {}, Status::cancelled);
    });
    checkpoint();
}

void SqliteStore::release(const Lease& lease) {
    essential([&] {
        const LeaseState state = read_state(m_database, lease);
        if (state == LeaseState::held) requeue(lease.id, lease.attempt - 1);
        if (state == LeaseState::cancel_requested) end_attempt(lease.id, {}, Status::cancelled);
    });
}

void SqliteStore::end_leases_of(const std::string& owner) {
    essential([&] { end_lost_leases("lease_owner = ?", owner); });
}

void SqliteStore::end_lost_leases(const std::string& condition, const std::string& value) {
    struct Lost {
        std::string id;
        int attempts;
        bool cancel_requested;
    };
    std::vector<Lost> all;
    SQLite::Statement rows(
        m_database, "SELECT id, attempts, cancel_requested FROM reports WHERE status = 'running' AND " + condition);
    rows.bind(1, value);
    while (rows.executeStep())
        all.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getInt(), rows.getColumn(2).getInt() != 0});
    rows.reset();
    for (const Lost& lost : all)
        end_attempt(lost.id, worker_died, after_lost_attempt(lost.attempts, lost.cancel_requested, m_rules));
}

void SqliteStore::end_attempt(const std::string& id, const JobError& error, Status status) {
    if (status == Status::queued) {
        SQLite::Statement row(m_database, "SELECT attempts FROM reports WHERE id = ?");
        row.bind(1, id);
        row.executeStep();
        const int attempts = row.getColumn(0).getInt();
        row.reset();
        return requeue(id, attempts);
    }
    SQLite::Statement end(m_database,
                          "UPDATE reports SET status = ?, finished_ms = ?, stage = '', revision = revision + 1, "
                          "lease_owner = NULL, lease_until_ms = NULL, error_title = ?, error_detail = ? WHERE id = ?");
    SQLite::bind(end, std::string(status_text(status)), m_clock());
    if (status == Status::failed) {
        end.bind(3, error.title);
        end.bind(4, error.detail);
    }
    end.bind(5, id);
    end.exec();
}

void SqliteStore::requeue(const std::string& id, int attempts) {
    SQLite::Statement back(m_database,
                           "UPDATE reports SET status = 'queued', progress = 0, stage = '', revision = revision + 1, "
                           "attempts = ?, lease_owner = NULL, lease_until_ms = NULL WHERE id = ?");
    SQLite::bind(back, attempts, id);
    back.exec();
}

void SqliteStore::note_rendered() {
    transacted(m_mutex, m_database, [&] { write_rendered(); });
}

void SqliteStore::write_rendered() {
    SQLite::Statement note(m_database,
                           "INSERT INTO health VALUES (1, ?1) ON CONFLICT (id) DO UPDATE SET last_rendered_ms = ?1");
    note.bind(1, m_clock());
    note.exec();
}

}  // namespace sheer
