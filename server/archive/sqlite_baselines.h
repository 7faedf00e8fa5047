#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/baselines.h"

namespace sheer {

class SqliteBaselines : public Baselines {
  public:
    explicit SqliteBaselines(SqliteArchive& archive) : m_archive(archive) {}
    Acceptance accept(const AcceptedReport& accepted) override;
    std::vector<AcceptedReport> list(const std::string& name) override;
    std::size_t forget(const std::string& name, const std::string& report_id) override;

  private:
    SqliteArchive& m_archive;
};

}  // namespace sheer
