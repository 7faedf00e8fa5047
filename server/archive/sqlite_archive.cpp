#include "server/archive/sqlite_archive.h"

#include <spdlog/spdlog.h>

#include "server/archive/sqlite_migrate.h"
#include "server/archive/sqlite_open.h"

namespace sheer {

namespace {

constexpr std::chrono::hours leftover_age{1};

/// Opening an archive again after its last process has ended needs room.
SQLite::Database open_with_reserve(const DataFolder& folder, DiskRoom& room) {
    try {
        return open_archive(folder);
    } catch (const StoreError&) {
        if (room.lack().empty() || !room.give_up_reserve()) throw;
    }
    return open_archive(folder);
}

}  // namespace

void throw_store_error(const SQLite::Exception& error) {
    // The second is the error if the log's index cannot grow.
    if (error.getErrorCode() == SQLITE_FULL || error.getExtendedErrorCode() == SQLITE_IOERR_SHMSIZE)
        throw StoreFull("the archive's disk is full");
    if (error.getErrorCode() == SQLITE_IOERR) throw DiskError(std::string("archive: ") + error.what());
    throw StoreError(std::string("archive: ") + error.what());
}

SqliteArchive::SqliteArchive(const DataFolder& folder, LeaseRules rules, ClockMs clock)
    : m_rules(rules),
      m_clock(std::move(clock)),
      m_blobs(folder.blobs()),
      m_assets(folder.assets()),
      m_room(folder),
      m_writer(open_with_reserve(folder, m_room)),
      m_readers(folder) {
    check_archive(m_writer, folder);
    m_blobs.make();
    m_assets.make();
    essential([&](SQLite::Database& database) { migrate_archive(database, folder); });
    m_blobs.remove_leftovers(leftover_age);
    m_assets.remove_leftovers(leftover_age);
    m_room.restore_reserve();
    checkpoint();
}

void SqliteArchive::checkpoint() {
    // PASSIVE does not wait: if there are readers of an older state, a part of the log is left for the next time.
    // TRUNCATE waits, to free the room that the log takes.
    const char* const pragma =
        m_room.lack().empty() ? "PRAGMA wal_checkpoint(PASSIVE)" : "PRAGMA wal_checkpoint(TRUNCATE)";
    try {
        const std::lock_guard lock(m_writing);
        m_checkpoint_due = !translated([&] {
            SQLite::Statement carry(m_writer, pragma);
            return carry.executeStep() && carry.getColumn(1).getInt() == carry.getColumn(2).getInt();
        });
    } catch (const StoreError& error) {
        // The log keeps what is not yet in the database.
        spdlog::warn("the log was not written to the database: {}", error.what());
        m_checkpoint_due = true;
    }
}

void SqliteArchive::finish_checkpoint() {
    if (m_checkpoint_due) checkpoint();
}

}  // namespace sheer
