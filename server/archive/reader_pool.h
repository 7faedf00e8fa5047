#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <memory>
#include <mutex>
#include <vector>

#include "server/archive/sqlite_open.h"
#include "server/storage/data_folder.h"

namespace sheer {

/// Connections that never write. Each reader has one for itself, so that none waits for another; there are as many as
/// have ever read at the same time.
class ReaderPool {
  public:
    explicit ReaderPool(DataFolder folder) : m_folder(std::move(folder)) {}

    /// The result of `work(database)`. Throws StoreError if a further connection cannot be opened.
    template <typename Work>
    auto use(const Work& work) {
        const Loan loan(*this);
        return work(*loan.database);
    }

  private:
    using DatabasePtr = std::unique_ptr<SQLite::Database>;

    struct Loan {
        explicit Loan(ReaderPool& lender) : pool(lender), database(lender.take()) {}
        Loan(const Loan&) = delete;
        Loan& operator=(const Loan&) = delete;
        ~Loan() {
            const std::lock_guard lock(pool.m_mutex);
            pool.m_free.push_back(std::move(database));
        }

        ReaderPool& pool;
        mutable DatabasePtr database;
    };

    DatabasePtr take() {
        {
            const std::lock_guard lock(m_mutex);
            // The one that was used last has the most in its cache.
            if (!m_free.empty()) {
                DatabasePtr database = std::move(m_free.back());
                m_free.pop_back();
                return database;
            }
        }
        return std::make_unique<SQLite::Database>(open_reader(m_folder));
    }

    const DataFolder m_folder;
    std::mutex m_mutex;
    std::vector<DatabasePtr> m_free;  ///< guarded by m_mutex
};

}  // namespace sheer
