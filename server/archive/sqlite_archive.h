#pragma once
#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <sqlite3.h>

#include <atomic>
#include <mutex>
#include <type_traits>

#include "renderer/core/clock.h"
#include "server/archive/disk_room.h"
#include "server/archive/reader_pool.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store_errors.h"
#include "server/storage/content_folder.h"
#include "server/storage/data_folder.h"

namespace sheer {

/// Throws the StoreError that corresponds to an exception of SQLite.
[[noreturn]] void throw_store_error(const SQLite::Exception& error);

/// What the parts of a SqliteStore share: the database, the files beside it, and the room on their disk.
///
/// There is one connection for writing, and others for reading, so that readers wait neither for the write lock nor for
/// each other: they read the state of the last commit.
class SqliteArchive {
  public:
    /// Makes what is missing, and brings the database up to date. Throws StoreError, also for an archive of a newer
    /// version; see open_archive.
    SqliteArchive(const DataFolder& folder, LeaseRules rules, ClockMs clock);

    /// Returns the result of `work(database)`, which only reads.
    template <typename Work>
    auto read(const Work& work) {
        return translated([&] { return m_readers.use(work); });
    }

    /// The same inside a transaction that holds the write lock from its start, so that what it read is still true when
    /// it writes.
    template <typename Work>
    auto write(const Work& work) {
        const std::lock_guard lock(m_writing);
        return translated([&] {
            SQLite::Transaction transaction(m_writer, SQLite::TransactionBehavior::IMMEDIATE);
            if constexpr (std::is_void_v<decltype(work(m_writer))>) {
                work(m_writer);
                transaction.commit();
            } else {
                auto result = work(m_writer);
                transaction.commit();
                return result;
            }
        });
    }

    /// A `write` that must succeed even on a full disk, since it makes room or records the outcome of a job: the
    /// reserve is given up for it. `work` may run twice.
    template <typename Work>
    auto essential(const Work& work) {
        try {
            return write(work);
        } catch (const StoreFull&) {
            m_room.give_up_reserve();
        }
        return write(work);
    }

    /// Writes the log to the database, so that a copy of its file alone has everything.
    void checkpoint();
    /// The same, if the last checkpoint left a part of the log.
    void finish_checkpoint();

    std::int64_t now_ms() const { return m_clock(); }
    const LeaseRules& rules() const { return m_rules; }
    ContentFolder& blobs() { return m_blobs; }
    ContentFolder& assets() { return m_assets; }
    DiskRoom& room() { return m_room; }

  private:
    template <typename Work>
    static auto translated(const Work& work) {
        try {
            return work();
        } catch (const SQLite::Exception& error) {
            throw_store_error(error);
        }
    }

    const LeaseRules m_rules;
    const ClockMs m_clock;
    ContentFolder m_blobs, m_assets;
    DiskRoom m_room;
    std::mutex m_writing;  ///< guards m_writer
    SQLite::Database m_writer;
    ReaderPool m_readers;
    std::atomic<bool> m_checkpoint_due = false;  ///< a part of the log was left
};

}  // namespace sheer
