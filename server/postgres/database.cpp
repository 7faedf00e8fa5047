#include "server/postgres/database.h"

#include "server/postgres/migrate.h"

namespace sheer::postgres {

Database::Database(Address address, LeaseRules rules, std::optional<ClockMs> made_up_clock)
    : m_address(std::move(address)), m_rules(rules), m_clock(std::move(made_up_clock)) {
    ConnectionPtr first = connect();
    migrate(*first, m_address);
    give_back(std::move(first));
}

Database::ConnectionPtr Database::connect() const {
    return std::make_unique<Connection>(m_address);
}

Database::ConnectionPtr Database::take() {
    {
        const std::lock_guard lock(m_mutex);
        if (!m_free.empty()) {
            ConnectionPtr connection = std::move(m_free.back());
            m_free.pop_back();
            return connection;
        }
    }
    return connect();
}

void Database::use_clock(Connection& connection) const {
    connection.run("SELECT set_config('sheer.now_ms', $1, false)", {std::to_string((*m_clock)())});
}

void Database::give_back(ConnectionPtr connection) {
    try {
        if (connection->is_in_transaction()) connection->script("ROLLBACK");
    } catch (const StoreError&) {
        return;
    }
    if (connection->is_lost()) return;
    const std::lock_guard lock(m_mutex);
    m_free.push_back(std::move(connection));
}

void Database::forget_connections() {
    std::vector<ConnectionPtr> lost;
    const std::lock_guard lock(m_mutex);
    lost.swap(m_free);
}

}  // namespace sheer::postgres
