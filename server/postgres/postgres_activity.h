#pragma once
#include "server/jobs/activity.h"
#include "server/jobs/readiness.h"
#include "server/jobs/usage.h"
#include "server/jobs/workers.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

class PostgresActivity : public Activity {
  public:
    explicit PostgresActivity(Database& database) : m_database(database) {}
    ActivityCounts counts() override;

  private:
    Database& m_database;
};

class PostgresWorkers : public Workers {
  public:
    explicit PostgresWorkers(Database& database) : m_database(database) {}
    void note(const SeenWorker& worker) override;
    std::vector<SeenWorker> list(std::int64_t age_ms) override;

  private:
    Database& m_database;
};

class PostgresUsage : public Usage {
  public:
    explicit PostgresUsage(Database& database) : m_database(database) {}
    TokenUse of(const std::string& token) override;
    void add_upload(const std::string& token, std::int64_t bytes) override;

  private:
    Database& m_database;
};

class PostgresReadiness : public Readiness {
  public:
    explicit PostgresReadiness(Database& database) : m_database(database) {}
    void note_rendered() override;
    std::optional<std::int64_t> last_rendered_ms() override;
    std::string lack_of_room() override;

  private:
    Database& m_database;
};

}  // namespace sheer::postgres
