#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/archive/sqlite_blobs.h"
#include "server/jobs/care.h"

namespace sheer {

class SqliteCare : public Care {
  public:
    SqliteCare(SqliteArchive& archive, SqliteBlobs& blobs, const DataFolder& folder)
        : m_archive(archive), m_blobs(blobs), m_folder(folder) {}
    CheckResult check(bool repair) override;
    Garbage collect_garbage() override;
    BackupResult back_up(const std::filesystem::path& folder) override;
    std::vector<StoredReport> stored_reports() override;
    Import import_report(const ImportedReport& report) override;
    StoreSize size() override;

  private:
    std::vector<std::string> names_without_row(const ContentFolder& folder, const std::string& table);
    void remove_unnamed(ContentFolder& folder, const std::string& table, Garbage& garbage);

    SqliteArchive& m_archive;
    SqliteBlobs& m_blobs;
    const DataFolder m_folder;
};

}  // namespace sheer
