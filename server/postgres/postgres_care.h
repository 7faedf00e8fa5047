#pragma once
#include "server/jobs/care.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

/// The database does a part of this work itself: it writes rows whole, and keeps references between them.
class PostgresCare : public Care {
  public:
    explicit PostgresCare(Database& database) : m_database(database) {}
    /// Throws StoreError if something is damaged and `repair` is wanted: a damaged database is restored from a backup.
    CheckResult check(bool repair) override;
    Garbage collect_garbage() override;
    /// Throws StoreError: pg_dump does it.
    BackupResult back_up(const std::filesystem::path& folder) override;
    std::vector<StoredReport> stored_reports() override;
    Import import_report(const ImportedReport& report) override;
    StoreSize size() override;

  private:
    Database& m_database;
};

}  // namespace sheer::postgres
