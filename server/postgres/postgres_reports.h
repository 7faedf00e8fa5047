#pragma once
#include "server/jobs/report_archive.h"
#include "server/jobs/trends.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

class PostgresReports : public ReportArchive {
  public:
    explicit PostgresReports(Database& database) : m_database(database) {}
    std::optional<ReportRecord> find(const std::string& id) override;
    ReportPage list(const ListFilter& filter) override;
    Removal remove(const std::string& id) override;

  private:
    Database& m_database;
};

class PostgresTrends : public Trends {
  public:
    explicit PostgresTrends(Database& database) : m_database(database) {}
    std::vector<TrendReport> reports(const ListFilter& filter) override;
    void keep(const std::string& report_id, const ReportNumbers& numbers) override;

  private:
    Database& m_database;
};

}  // namespace sheer::postgres
