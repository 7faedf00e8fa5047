#pragma once
#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <sqlite3.h>

#include <mutex>
#include <string>

#include "server/jobs/store.h"

namespace sheer {

/// Runs `work` under `mutex` and turns SQLite's exceptions into StoreError.
template <typename Work>
auto guarded(std::mutex& mutex, Work&& work) {
    const std::lock_guard lock(mutex);
    try {
        return work();
    } catch (const SQLite::Exception& error) {
        // The second is what a log's index says that cannot grow.
        if (error.getErrorCode() == SQLITE_FULL || error.getExtendedErrorCode() == SQLITE_IOERR_SHMSIZE)
            throw StoreFull("the archive's disk is full");
        if (error.getErrorCode() == SQLITE_IOERR) throw DiskError(std::string("archive: ") + error.what());
        throw StoreError(std::string("archive: ") + error.what());
    }
}

/// The same inside a transaction that holds the write lock from its start, so that what it read is still so when it
/// writes.
template <typename Work>
auto transacted(std::mutex& mutex, SQLite::Database& database, Work&& work) {
    return guarded(mutex, [&] {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        if constexpr (std::is_void_v<decltype(work())>) {
            work();
            transaction.commit();
        } else {
            auto result = work();
            transaction.commit();
            return result;
        }
    });
}

}  // namespace sheer
