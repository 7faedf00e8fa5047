#pragma once
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "server/archive/sqlite_archive.h"
#include "server/jobs/care.h"

namespace sheer {

/// Finds what is wrong with an archive (see Care::check). Reports and files that are being written or deleted meanwhile
/// are looked at again under the write lock before anything is said of them.
class SqliteCheck {
  public:
    SqliteCheck(SqliteArchive& archive, const DataFolder& folder) : m_archive(archive), m_folder(folder) {}

    /// Once.
    CheckResult run();

    // What a repair can do something about.
    const std::vector<std::string>& broken_reports() const { return m_broken_reports; }
    const std::vector<std::filesystem::path>& damaged_files() const { return m_damaged_files; }
    const std::vector<std::filesystem::path>& unnamed_files() const { return m_unnamed_files; }
    bool index_is_wrong() const { return m_index_is_wrong; }

  private:
    using Kind = Finding::Kind;

    void add(Kind kind, std::string text) { m_result.findings.push_back({kind, std::move(text)}); }
    /// Runs one part; an exception becomes a finding.
    void part(const std::string& name, const std::function<void()>& check);

    void check_database();
    void check_schema();
    void check_index();
    void check_reports();
    void check_report(SQLite::Database& database, const std::string& id);
    void check_seals(const std::string& table, const std::string& key, const std::string& what);
    void check_blobs();
    void check_assets();
    /// One file of `folder` that must exist.
    void check_file(const ContentFolder& folder, const std::string& sha256, std::int64_t size_bytes,
                    const std::string& what, const std::string& table);
    void check_files(const ContentFolder& folder, const std::filesystem::path& root, const std::string& table);
    void check_scratch();
    bool has_row(const std::string& table, const std::string& sha256);
    bool is_busy();

    SqliteArchive& m_archive;
    const DataFolder m_folder;
    CheckResult m_result;
    std::vector<std::string> m_broken_reports;
    std::vector<std::filesystem::path> m_damaged_files, m_unnamed_files;
    bool m_index_is_wrong = false;
};

}  // namespace sheer
