#include "server/archive/sqlite_blobs.h"

namespace sheer {

std::optional<std::string> SqliteBlobs::media_type_of(const std::string& sha256) {
    return m_archive.read([&](SQLite::Database& database) -> std::optional<std::string> {
        SQLite::Statement row(database, "SELECT media_type FROM blobs WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) return std::nullopt;
        return row.getColumn(0).getString();
    });
}

std::optional<Blob> SqliteBlobs::open(const std::string& sha256) {
    const auto media_type = media_type_of(sha256);
    if (!media_type) return std::nullopt;
    try {
        return Blob{*media_type, m_archive.blobs().open(sha256)};
    } catch (const DamagedData&) {
        // It may have been deleted in between.
        if (!media_type_of(sha256)) return std::nullopt;
        throw;
    }
}

void SqliteBlobs::add(SQLite::Database& database, const std::string& report, const BlobName& blob) {
    SQLite::Statement keep(database, "INSERT INTO blobs VALUES (?, ?, ?) ON CONFLICT DO NOTHING");
    SQLite::bind(keep, blob.sha256, blob.media_type, m_archive.blobs().size_bytes(blob.sha256));
    keep.exec();
    SQLite::Statement name(database, "INSERT INTO report_blobs VALUES (?, ?) ON CONFLICT DO NOTHING");
    SQLite::bind(name, report, blob.sha256);
    name.exec();
}

void SqliteBlobs::remove(const std::vector<std::string>& candidates) {
    // The rows go first, and the files after the commit: if the machine stops in between, an extra file is left but
    // none is lost. Both steps hold the write lock, so that no worker can commit a report that names a file that is
    // being removed.
    std::vector<std::string> unnamed;
    m_archive.essential([&](SQLite::Database& database) {
        unnamed.clear();
        for (const std::string& sha256 : candidates) {
            SQLite::Statement drop(database,
                                   "DELETE FROM blobs WHERE sha256 = ?1 AND NOT EXISTS "
                                   "(SELECT 1 FROM report_blobs WHERE sha256 = ?1)");
            drop.bind(1, sha256);
            if (drop.exec() > 0) unnamed.push_back(sha256);
        }
    });
    remove_unnamed_files(unnamed);
}

void SqliteBlobs::remove_of_parts(const std::string& report) {
    const std::string named =
        "report_id = ? AND EXISTS (SELECT 1 FROM reports WHERE id = report_id AND status IN ('failed', 'cancelled'))";
    const auto names_of = [&](SQLite::Database& database) {
        std::vector<std::string> names;
        SQLite::Statement rows(database, "SELECT sha256 FROM report_blobs WHERE " + named);
        rows.bind(1, report);
        while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
        return names;
    };
    const std::vector<std::string> names = m_archive.read(names_of);
    if (names.empty()) return;
    m_archive.essential([&](SQLite::Database& database) {
        SQLite::Statement drop(database, "DELETE FROM report_blobs WHERE " + named);
        drop.bind(1, report);
        drop.exec();
    });
    remove(names);
}

void SqliteBlobs::remove_unnamed_files(const std::vector<std::string>& candidates) {
    m_archive.essential([&](SQLite::Database& database) {
        for (const std::string& sha256 : candidates) {
            SQLite::Statement named(database, "SELECT 1 FROM blobs WHERE sha256 = ?");
            named.bind(1, sha256);
            if (!named.executeStep()) m_archive.blobs().remove(sha256);
        }
    });
}

}  // namespace sheer
