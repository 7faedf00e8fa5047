#pragma once
#include "server/archive/sqlite_blobs.h"
#include "server/jobs/report_archive.h"

namespace sheer {

class SqliteReports : public ReportArchive {
  public:
    SqliteReports(SqliteArchive& archive, SqliteBlobs& blobs) : m_archive(archive), m_blobs(blobs) {}
    std::optional<ReportRecord> find(const std::string& id) override;
    ReportPage list(const ListFilter& filter) override;
    Removal remove(const std::string& id) override;

  private:
    SqliteArchive& m_archive;
    SqliteBlobs& m_blobs;
};

}  // namespace sheer
