#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/activity.h"
#include "server/jobs/usage.h"
#include "server/jobs/workers.h"

namespace sheer {

class SqliteActivity : public Activity {
  public:
    explicit SqliteActivity(SqliteArchive& archive) : m_archive(archive) {}
    ActivityCounts counts() override;

  private:
    SqliteArchive& m_archive;
};

class SqliteWorkers : public Workers {
  public:
    explicit SqliteWorkers(SqliteArchive& archive) : m_archive(archive) {}
    void note(const SeenWorker& worker) override;
    std::vector<SeenWorker> list(std::int64_t age_ms) override;

  private:
    SqliteArchive& m_archive;
};

class SqliteUsage : public Usage {
  public:
    explicit SqliteUsage(SqliteArchive& archive) : m_archive(archive) {}
    TokenUse of(const std::string& token) override;
    void add_upload(const std::string& token, std::int64_t bytes) override;

  private:
    SqliteArchive& m_archive;
};

// Inside a transaction.

void count_lost_lease(SQLite::Database& database);
/// Adds the time since the job's last heartbeat to the stage in which it was since then, and to its token. Call it
/// before the heartbeat or the job's end is written.
void count_stage_time(SQLite::Database& database, const SqliteArchive& archive, const std::string& id);
TokenUse use_of(SQLite::Database& database, std::int64_t now_ms, const std::string& token);

}  // namespace sheer
