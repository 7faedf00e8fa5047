#pragma once
#include <vector>

#include "server/archive/sqlite_archive.h"
#include "server/jobs/blobs.h"

namespace sheer {

/// Each picture has a row with its type, rows for the reports that name it, and a file.
class SqliteBlobs : public Blobs {
  public:
    explicit SqliteBlobs(SqliteArchive& archive) : m_archive(archive) {}
    std::optional<Blob> open(const std::string& sha256) override;

    /// Inside a transaction: records that `report` names this picture, whose file exists.
    void add(SQLite::Database& database, const std::string& report, const BlobName& blob);
    /// Removes those `candidates` that no report names.
    void remove(const std::vector<std::string>& candidates);
    /// Those that the parts of a report have named, if it ended without being done.
    void remove_of_parts(const std::string& report);
    /// Removes the files of those `candidates` that have no row.
    void remove_unnamed_files(const std::vector<std::string>& candidates);

  private:
    std::optional<std::string> media_type_of(const std::string& sha256);

    SqliteArchive& m_archive;
};

}  // namespace sheer
