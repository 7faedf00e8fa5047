#include "server/postgres/postgres_watch.h"

#include <fmt/format.h>

namespace sheer::postgres {

PostgresWatch::PostgresWatch(Address address, std::string channel)
    : m_address(std::move(address)), m_channel(std::move(channel)) {
    listen();
}

void PostgresWatch::listen() {
    m_connection = std::make_unique<Connection>(m_address);
    m_connection->script(fmt::format("LISTEN {}", m_channel));
}

bool PostgresWatch::wait(std::chrono::milliseconds limit) {
    if (!m_connection) {
        listen();
        return true;
    }
    try {
        return m_connection->wait_for_notification(limit);
    } catch (const StoreUnreachable&) {
        m_connection.reset();
        throw;
    }
}

int PostgresWatch::descriptor() {
    return m_connection ? m_connection->descriptor() : -1;
}

}  // namespace sheer::postgres
