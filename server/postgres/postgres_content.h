#pragma once
#include "server/jobs/assets.h"
#include "server/jobs/blobs.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

/// Pictures are rows with their bytes, and rows for the reports that name them.
class PostgresBlobs : public Blobs {
  public:
    explicit PostgresBlobs(Database& database) : m_database(database) {}
    std::optional<Blob> open(const std::string& sha256) override;

  private:
    Database& m_database;
};

class PostgresAssets : public Assets {
  public:
    explicit PostgresAssets(Database& database) : m_database(database) {}
    void add(const Asset& asset, const std::string& bytes) override;
    std::optional<Asset> find(const std::string& sha256) override;
    std::optional<OpenAsset> open(const std::string& sha256) override;
    std::vector<Asset> list(int limit) override;
    Removal remove(const std::string& sha256) override;

  private:
    Database& m_database;
};

}  // namespace sheer::postgres
