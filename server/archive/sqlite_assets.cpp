#include "server/archive/sqlite_guard.h"
#include "server/archive/sqlite_store.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* select_assets =
    "SELECT sha256, type, media_type, name, size_bytes, created_ms, facts FROM assets ";

/// The whole spec is searched: a SHA-256 stands in it by chance in no spec.
bool is_waited_for(SQLite::Database& database, const std::string& sha256) {
    SQLite::Statement row(database,
                          "SELECT 1 FROM reports WHERE status IN ('queued', 'running') AND instr(spec, ?) > 0");
    row.bind(1, sha256);
    return row.executeStep();
}

}  // namespace

Asset SqliteStore::read_asset(SQLite::Statement& row) const {
    Asset asset{.sha256 = row.getColumn(0).getString(),
                .type = row.getColumn(1).getString(),
                .media_type = row.getColumn(2).getString(),
                .name = row.getColumn(3).getString(),
                .size_bytes = row.getColumn(4).getInt64(),
                .created_ms = row.getColumn(5).getInt64(),
                .facts = json::parse(row.getColumn(6).getString())};
    const auto path = m_assets.find(asset.sha256);
    if (!path) throw StoreError("archive: the file of asset " + asset.sha256 + " is missing");
    asset.path = *path;
    return asset;
}

void SqliteStore::add_asset(const Asset& asset, const std::string& bytes) {
    m_assets.put(asset.sha256, bytes);
    transacted(m_mutex, m_database, [&] {
        // Before the write lock was held a deletion may have taken the file.
        m_assets.put(asset.sha256, bytes);
        SQLite::Statement insert(m_database, "INSERT INTO assets VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
        SQLite::bind(insert, asset.sha256, asset.type, asset.media_type, asset.name, asset.size_bytes, m_clock(),
                     asset.facts.dump());
        insert.exec();
    });
}

std::optional<Asset> SqliteStore::find_asset(const std::string& sha256) {
    return guarded(m_mutex, [&]() -> std::optional<Asset> {
        SQLite::Statement row(m_database, std::string(select_assets) + "WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) return std::nullopt;
        return read_asset(row);
    });
}

std::vector<Asset> SqliteStore::list_assets(int limit) {
    return guarded(m_mutex, [&] {
        SQLite::Statement rows(m_database, std::string(select_assets) + "ORDER BY created_ms DESC, rowid DESC LIMIT ?");
        rows.bind(1, limit);
        std::vector<Asset> assets;
        while (rows.executeStep()) assets.push_back(read_asset(rows));
        return assets;
    });
}

RemoveAssetResult SqliteStore::remove_asset(const std::string& sha256) {
    using Result = RemoveAssetResult;
    const Result result = transacted(m_mutex, m_database, [&] {
        if (is_waited_for(m_database, sha256)) return Result::in_use;
        SQLite::Statement drop(m_database, "DELETE FROM assets WHERE sha256 = ?");
        drop.bind(1, sha256);
        return drop.exec() > 0 ? Result::removed : Result::not_found;
    });
    if (result != Result::removed) return result;
    // The row first and the file after its commit, as with blobs: a crash leaves a file too many, never one too few.
    transacted(m_mutex, m_database, [&] {
        SQLite::Statement again(m_database, "SELECT 1 FROM assets WHERE sha256 = ?");
        again.bind(1, sha256);
        if (!again.executeStep()) m_assets.remove(sha256);
    });
    return result;
}

}  // namespace sheer
