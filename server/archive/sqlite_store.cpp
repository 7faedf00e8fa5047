#include "server/archive/sqlite_store.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>

#include "embedded_server_files.h"
#include "server/archive/sqlite_guard.h"
#include "server/archive/sqlite_open.h"
#include "server/jobs/facets.h"

namespace sheer {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

// What makes an archive of version N out of one of version N-1.
constexpr std::array migrations = {"schema.sql", "assets.sql", "retries.sql"};
constexpr std::chrono::hours leftover_age{1};

/// An archive whose last process ended needs room to be opened again.
SQLite::Database open_with_reserve(const fs::path& folder, DiskRoom& room) {
    try {
        return open_archive(folder);
    } catch (const StoreError&) {
        if (room.lack().empty() || !room.give_up_reserve()) throw;
    }
    return open_archive(folder);
}

std::string sql_file(const std::string& name) {
    for (const EmbeddedFile& file : embedded_server_files())
        if (file.path == name) return std::string(file.bytes);
    throw StoreError("the program was built without " + name);
}

std::optional<std::int64_t> optional_int(const SQLite::Column& column) {
    if (column.isNull()) return std::nullopt;
    return column.getInt64();
}

std::optional<JobError> error_of(const SQLite::Column& title, const SQLite::Column& detail) {
    if (title.isNull()) return std::nullopt;
    return JobError{title.getString(), detail.getString()};
}

Status status_of(const SQLite::Column& column) {
    const auto status = status_from(column.getString());
    if (!status) throw StoreError("archive: unknown status " + column.getString());
    return *status;
}

}  // namespace

SqliteStore::SqliteStore(const fs::path& folder, LeaseRules rules, ClockMs clock)
    : m_rules(rules),
      m_clock(std::move(clock)),
      m_blobs(folder / "blobs"),
      m_assets(folder / "assets"),
      m_room(folder),
      m_database(open_with_reserve(folder, m_room)),
      m_watch(open_archive(folder)) {
    check_archive(m_database, folder);
    essential([&] { migrate(folder); });
    m_blobs.remove_leftovers(leftover_age);
    m_assets.remove_leftovers(leftover_age);
    m_room.restore_reserve();
    checkpoint();
}

void SqliteStore::migrate(const fs::path& folder) {
    const auto version = m_database.execAndGet("PRAGMA user_version").getInt64();
    if (version < 0 || static_cast<std::size_t>(version) > migrations.size())
        throw StoreError(fmt::format("the archive in {} has version {}, this program knows version {}", folder.string(),
                                     version, migrations.size()));
    for (auto i = static_cast<std::size_t>(version); i < migrations.size(); ++i)
        m_database.exec(sql_file(migrations[i]));
    m_database.exec(fmt::format("PRAGMA user_version = {}", migrations.size()));
    m_database.exec(fmt::format("PRAGMA application_id = {}", archive_application_id));
}

void SqliteStore::checkpoint() {
    // PASSIVE waits for nobody: readers of an older state leave a part of the log to the next time. TRUNCATE does, for
    // the room that the log takes.
    const char* const pragma =
        m_room.lack().empty() ? "PRAGMA wal_checkpoint(PASSIVE)" : "PRAGMA wal_checkpoint(TRUNCATE)";
    try {
        m_checkpoint_due = !guarded(m_mutex, [&] {
            SQLite::Statement carry(m_database, pragma);
            return carry.executeStep() && carry.getColumn(1).getInt() == carry.getColumn(2).getInt();
        });
    } catch (const StoreError& error) {
        // The log keeps what the database has not got yet.
        spdlog::warn("the log is not carried over: {}", error.what());
        m_checkpoint_due = true;
    }
}

std::string SqliteStore::lack_of_room() {
    if (!m_room.lack().empty()) checkpoint();
    m_room.restore_reserve();
    return guarded(m_mutex, [&] { return find_lack_of_room(); });
}

std::string SqliteStore::find_lack_of_room() {
    if (std::string lack = m_room.lack(); !lack.empty()) return lack;
    SQLite::Statement waiting(m_database,
                              "SELECT not_before_ms FROM reports WHERE status = 'queued' AND not_before_ms > 0 AND "
                              "not_before_ms > ? AND lacks_room <> 0 ORDER BY not_before_ms LIMIT 1");
    const std::int64_t now_ms = m_clock();
    waiting.bind(1, now_ms);
    if (!waiting.executeStep()) return "";
    return fmt::format("a report did not fit on the archive's disk and is tried again in {} s",
                       (waiting.getColumn(0).getInt64() - now_ms) / 1000 + 1);
}

SubmitResult SqliteStore::submit(const NewReport& report, std::size_t max_queued) {
    using Outcome = SubmitResult::Outcome;
    m_room.restore_reserve();
    return transacted(m_mutex, m_database, [&]() -> SubmitResult {
        if (report.idempotency) {
            SQLite::Statement known(m_database, "SELECT id, body_sha256 FROM reports WHERE idempotency_key = ?");
            known.bind(1, report.idempotency->key);
            if (known.executeStep()) {
                const bool same = known.getColumn(1).getString() == report.idempotency->body_sha256;
                return {same ? Outcome::repeated : Outcome::key_reused, known.getColumn(0).getString()};
            }
        }
        const auto queued = m_database.execAndGet("SELECT count(*) FROM reports WHERE status = 'queued'").getInt64();
        if (static_cast<std::size_t>(queued) >= max_queued) return {Outcome::queue_full, ""};
        if (const std::string lack = find_lack_of_room(); !lack.empty()) throw StoreFull(lack);
        insert_report(report);
        return {Outcome::created, report.id};
    });
}

void SqliteStore::insert_report(const NewReport& report) {
    const Facets facets = facets_of(json::parse(report.spec));
    SQLite::Statement insert(m_database,
                             "INSERT INTO reports (id, status, created_ms, title, scene, spec, spec_sha256, "
                             "idempotency_key, body_sha256) VALUES (?, 'queued', ?, ?, ?, ?, ?, ?, ?)");
    SQLite::bind(insert, report.id, m_clock(), facets.title, facets.scene, report.spec, report.spec_sha256);
    if (report.idempotency) {
        insert.bind(7, report.idempotency->key);
        insert.bind(8, report.idempotency->body_sha256);
    }
    insert.exec();
    for (std::size_t i = 0; i < facets.methods.size(); ++i) {
        SQLite::Statement method(m_database, "INSERT INTO report_methods VALUES (?, ?, ?)");
        SQLite::bind(method, report.id, static_cast<std::int64_t>(i), facets.methods[i]);
        method.exec();
    }
    for (const auto& [name, value] : facets.tags.items()) {
        SQLite::Statement tag(m_database, "INSERT INTO report_tags VALUES (?, ?, ?)");
        SQLite::bind(tag, report.id, name, value.get<std::string>());
        tag.exec();
    }
}

std::optional<ReportRecord> SqliteStore::find(const std::string& id) {
    return guarded(m_mutex, [&]() -> std::optional<ReportRecord> {
        SQLite::Statement row(m_database,
                              "SELECT status, progress, stage, revision, created_ms, finished_ms, spec, spec_sha256, "
                              "error_title, error_detail, coalesce(report, '') FROM reports WHERE id = ?");
        row.bind(1, id);
        if (!row.executeStep()) return std::nullopt;
        ReportRecord record{.id = id, .status = status_of(row.getColumn(0))};
        record.progress = row.getColumn(1).getDouble();
        record.stage = row.getColumn(2).getString();
        record.revision = row.getColumn(3).getInt64();
        record.created_ms = row.getColumn(4).getInt64();
        record.finished_ms = optional_int(row.getColumn(5));
        record.spec = row.getColumn(6).getString();
        record.spec_sha256 = row.getColumn(7).getString();
        record.error = error_of(row.getColumn(8), row.getColumn(9));
        record.report = row.getColumn(10).getString();
        return record;
    });
}

RemoveResult SqliteStore::remove(const std::string& id) {
    std::vector<std::string> candidates;
    const RemoveResult result = essential([&] {
        candidates.clear();
        SQLite::Statement row(m_database, "SELECT status FROM reports WHERE id = ?");
        row.bind(1, id);
        if (!row.executeStep()) return RemoveResult::not_found;
        const Status status = status_of(row.getColumn(0));
        row.reset();
        if (status == Status::queued) {
            end_attempt(id, {}, Status::cancelled);
            return RemoveResult::cancelled;
        }
        if (status == Status::running) {
            SQLite::Statement ask(m_database, "UPDATE reports SET cancel_requested = 1 WHERE id = ?");
            ask.bind(1, id);
            ask.exec();
            return RemoveResult::cancelling;
        }
        SQLite::Statement named(m_database, "SELECT sha256 FROM report_blobs WHERE report_id = ?");
        named.bind(1, id);
        while (named.executeStep()) candidates.push_back(named.getColumn(0).getString());
        named.reset();
        SQLite::Statement gone(m_database, "DELETE FROM reports WHERE id = ?");
        gone.bind(1, id);
        gone.exec();
        try_again_what_lacked_room();
        return RemoveResult::deleted;
    });
    if (result == RemoveResult::deleted) remove_blobs(candidates);
    checkpoint();
    m_room.restore_reserve();
    return result;
}

void SqliteStore::remove_blobs(const std::vector<std::string>& candidates) {
    // The rows go first and the files after the commit: if the machine stops in between, a file too many is left, never
    // one too few. Both steps hold the write lock, so that no commit of a worker can come to rely on a file that goes.
    std::vector<std::string> unnamed;
    essential([&] {
        unnamed.clear();
        for (const std::string& sha256 : candidates) {
            SQLite::Statement drop(m_database,
                                   "DELETE FROM blobs WHERE sha256 = ?1 AND NOT EXISTS "
                                   "(SELECT 1 FROM report_blobs WHERE sha256 = ?1)");
            drop.bind(1, sha256);
            if (drop.exec() > 0) unnamed.push_back(sha256);
        }
    });
    remove_unnamed_files(unnamed);
}

void SqliteStore::remove_unnamed_files(const std::vector<std::string>& candidates) {
    essential([&] {
        for (const std::string& sha256 : candidates) {
            SQLite::Statement named(m_database, "SELECT 1 FROM blobs WHERE sha256 = ?");
            named.bind(1, sha256);
            if (!named.executeStep()) m_blobs.remove(sha256);
        }
    });
}

void SqliteStore::try_again_what_lacked_room() {
    m_database.exec("UPDATE reports SET not_before_ms = 0 WHERE status = 'queued' AND lacks_room <> 0");
}

std::optional<std::string> SqliteStore::media_type_of_blob(const std::string& sha256) {
    return guarded(m_mutex, [&]() -> std::optional<std::string> {
        SQLite::Statement row(m_database, "SELECT media_type FROM blobs WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) return std::nullopt;
        return row.getColumn(0).getString();
    });
}

std::optional<Blob> SqliteStore::find_blob(const std::string& sha256) {
    const auto media_type = media_type_of_blob(sha256);
    if (!media_type) return std::nullopt;
    try {
        return Blob{sha256, *media_type, m_blobs.find_whole(sha256)};
    } catch (const DamagedFile&) {
        // A deletion may have come in between.
        if (!media_type_of_blob(sha256)) return std::nullopt;
        throw;
    }
}

std::int64_t SqliteStore::change_counter() {
    return guarded(m_watch_mutex, [&] { return m_watch.execAndGet("PRAGMA data_version").getInt64(); });
}

std::optional<std::int64_t> SqliteStore::last_rendered_ms() {
    return guarded(m_mutex, [&]() -> std::optional<std::int64_t> {
        SQLite::Statement row(m_database, "SELECT last_rendered_ms FROM health");
        if (!row.executeStep()) return std::nullopt;
        return row.getColumn(0).getInt64();
    });
}

}  // namespace sheer
