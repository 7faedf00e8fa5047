#include <spdlog/spdlog.h>

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
                .facts = json::parse(row.getColumn(6).getString(), nullptr, false)};
    if (!asset.facts.is_object()) {
        asset.facts = json::object();
        asset.broken = "what is known of it cannot be read";
    }
    if (const auto path = m_assets.find(asset.sha256)) {
        asset.path = *path;
    } else {
        asset.broken = "its file is missing";
    }
    if (!asset.broken.empty()) spdlog::error("asset {}: {}", asset.sha256, asset.broken);
    return asset;
}

void SqliteStore::add_asset(const Asset& asset, const std::string& bytes) {
    if (const std::string lack = lack_of_room(); !lack.empty()) throw StoreFull(lack);
    m_assets.put(asset.sha256, bytes);
    try {
        transacted(m_mutex, m_database, [&] {
            // Before the write lock was held a deletion may have taken the file.
            if (!m_assets.find(asset.sha256)) m_assets.put(asset.sha256, bytes);
            SQLite::Statement insert(m_database,
                                     "INSERT INTO assets VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
            SQLite::bind(insert, asset.sha256, asset.type, asset.media_type, asset.name, asset.size_bytes, m_clock(),
                         asset.facts.dump());
            insert.exec();
        });
    } catch (const StoreError&) {
        remove_asset_file_without_row(asset.sha256);
        throw;
    }
    checkpoint();
}

void SqliteStore::remove_asset_file_without_row(const std::string& sha256) {
    essential([&] {
        SQLite::Statement row(m_database, "SELECT 1 FROM assets WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) m_assets.remove(sha256);
    });
}

std::optional<Asset> SqliteStore::find_whole_asset(const std::string& sha256) {
    auto asset = find_asset(sha256);
    if (!asset) return std::nullopt;
    try {
        asset->path = m_assets.find_whole(sha256);
        return asset;
    } catch (const DamagedFile&) {
        // A deletion may have come in between.
        if (!find_asset(sha256)) return std::nullopt;
        throw;
    }
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
    if (!is_sha256(sha256)) return Result::not_found;
    const Result result = essential([&] {
        if (is_waited_for(m_database, sha256)) return Result::in_use;
        SQLite::Statement drop(m_database, "DELETE FROM assets WHERE sha256 = ?");
        drop.bind(1, sha256);
        if (drop.exec() == 0) return Result::not_found;
        try_again_what_lacked_room();
        return Result::removed;
    });
    if (result != Result::removed) return result;
    // The row first and the file after its commit, as with blobs: a crash leaves a file too many, never one too few.
    remove_asset_file_without_row(sha256);
    checkpoint();
    m_room.restore_reserve();
    return result;
}

}  // namespace sheer
