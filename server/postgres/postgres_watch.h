#pragma once
#include <memory>
#include <string>

#include "server/jobs/change_watch.h"
#include "server/postgres/connection.h"

namespace sheer::postgres {

/// Listens on a connection of its own for what writers notify. If the connection was lost, something may have been
/// missed: then there is a new one, and a change is reported.
class PostgresWatch : public ChangeWatch {
  public:
    /// Throws StoreUnreachable.
    PostgresWatch(Address address, std::string channel);
    bool wait(std::chrono::milliseconds limit) override;
    int descriptor() override;

  private:
    void listen();

    const Address m_address;
    const std::string m_channel;
    std::unique_ptr<Connection> m_connection;
};

}  // namespace sheer::postgres
