#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <type_traits>
#include <vector>

#include "renderer/core/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/postgres/connection.h"

namespace sheer::postgres {

/// What the parts of a PostgresStore share: connections to one database. Each caller has one for itself, so that none
/// waits for another; there are as many as were ever used at the same time. One that was lost is replaced.
///
/// The time is that of the database, which the function now_ms() of its schema tells, so that machines need not agree.
class Database {
  public:
    /// `made_up_clock`: for tests; it takes the place of the database's. Brings the schema up to date. Throws
    /// StoreError, see migrate().
    Database(Address address, LeaseRules rules, std::optional<ClockMs> made_up_clock);

    /// The result of `work(connection)`, whose statements see each the state of its own time. It may run twice, so it
    /// must not write.
    template <typename Work>
    auto read(const Work& work) {
        return with_connection([&](Connection& connection, bool&) { return work(connection); });
    }

    /// The same inside a transaction that sees one state and does not write.
    template <typename Work>
    auto read_one_state(const Work& work) {
        return in_transaction("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY", work);
    }

    /// The same inside a transaction, which is rolled back after an exception. `work` may run more than once: until
    /// nothing is in its way, and once more if the connection was lost before the end.
    template <typename Work>
    auto write(const Work& work) {
        return in_transaction("BEGIN", work);
    }

    /// A `write` that does not wait for the disk of the database: it may be forgotten if the database's machine fails.
    template <typename Work>
    auto write_lightly(const Work& work) {
        return in_transaction("BEGIN; SET LOCAL synchronous_commit = off", work);
    }

    const LeaseRules& rules() const { return m_rules; }
    const Address& address() const { return m_address; }

  private:
    using ConnectionPtr = std::unique_ptr<Connection>;

    ConnectionPtr take();
    ConnectionPtr connect() const;
    void forget_connections();
    void use_clock(Connection& connection) const;
    /// A connection that was used is free again, unless it is lost or may be inside a transaction.
    void give_back(ConnectionPtr connection);

    /// `work(connection, tried_for_good)` sets the flag before it does what must not be done twice.
    template <typename Work>
    auto with_connection(const Work& work) {
        constexpr int most_conflicts = 20;
        for (int conflicts = 0, losses = 0;;) {
            bool tried_for_good = false;
            ConnectionPtr connection = take();
            try {
                if (m_clock) use_clock(*connection);
                if constexpr (std::is_void_v<decltype(work(*connection, tried_for_good))>) {
                    work(*connection, tried_for_good);
                    return give_back(std::move(connection));
                } else {
                    auto result = work(*connection, tried_for_good);
                    give_back(std::move(connection));
                    return result;
                }
            } catch (const Conflict&) {
                give_back(std::move(connection));
                if (++conflicts == most_conflicts) throw;
            } catch (const StoreUnreachable&) {
                // The others are likely to be lost as well.
                forget_connections();
                if (tried_for_good || ++losses > 1) throw;
            } catch (const std::exception&) {
                give_back(std::move(connection));
                throw;
            }
        }
    }

    template <typename Work>
    auto in_transaction(const char* begin, const Work& work) {
        return with_connection([&](Connection& connection, bool& tried_for_good) {
            connection.script(begin);
            if constexpr (std::is_void_v<decltype(work(connection))>) {
                work(connection);
                tried_for_good = true;
                connection.script("COMMIT");
            } else {
                auto result = work(connection);
                tried_for_good = true;
                connection.script("COMMIT");
                return result;
            }
        });
    }

    const Address m_address;
    const LeaseRules m_rules;
    const std::optional<ClockMs> m_clock;
    std::mutex m_mutex;
    std::vector<ConnectionPtr> m_free;  ///< guarded by m_mutex
};

}  // namespace sheer::postgres
