#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/assets.h"

namespace sheer {

class SqliteAssets : public Assets {
  public:
    explicit SqliteAssets(SqliteArchive& archive) : m_archive(archive) {}
    void add(const Asset& asset, const std::string& bytes) override;
    std::optional<Asset> find(const std::string& sha256) override;
    std::optional<OpenAsset> open(const std::string& sha256) override;
    std::vector<Asset> list(int limit) override;
    Removal remove(const std::string& sha256) override;

  private:
    Asset read_asset(SQLite::Statement& row) const;
    void remove_file_without_row(const std::string& sha256);

    SqliteArchive& m_archive;
};

}  // namespace sheer
