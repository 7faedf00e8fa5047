#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/trends.h"

namespace sheer {

class SqliteTrends : public Trends {
  public:
    explicit SqliteTrends(SqliteArchive& archive) : m_archive(archive) {}
    std::vector<TrendReport> reports(const ListFilter& filter) override;
    void keep(const std::string& report_id, const ReportNumbers& numbers) override;

  private:
    SqliteArchive& m_archive;
};

/// Inside a transaction; a report that has numbers keeps them.
void add_numbers(SQLite::Database& database, const std::string& report_id, const ReportNumbers& numbers);

}  // namespace sheer
