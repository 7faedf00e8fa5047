#pragma once
#include "server/jobs/baselines.h"
#include "server/jobs/pins.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

class PostgresBaselines : public Baselines {
  public:
    explicit PostgresBaselines(Database& database) : m_database(database) {}
    Acceptance accept(const AcceptedReport& accepted) override;
    std::vector<AcceptedReport> list(const std::string& name) override;
    std::size_t forget(const std::string& name, const std::string& report_id) override;

  private:
    Database& m_database;
};

class PostgresPins : public Pins {
  public:
    explicit PostgresPins(Database& database) : m_database(database) {}
    Pinning pin(const Pin& pin) override;
    std::optional<Pin> find(const std::string& report_id) override;
    bool unpin(const std::string& report_id) override;

  private:
    Database& m_database;
};

}  // namespace sheer::postgres
