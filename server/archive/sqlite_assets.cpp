#include "server/archive/sqlite_assets.h"

#include <spdlog/spdlog.h>

#include "renderer/core/sha256.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* select_assets =
    "SELECT sha256, type, media_type, name, size_bytes, created_ms, facts FROM assets ";

/// The whole spec is searched: no spec contains a SHA-256 by chance.
bool is_waited_for(SQLite::Database& database, const std::string& sha256) {
    SQLite::Statement row(database,
                          "SELECT 1 FROM reports WHERE status IN ('queued', 'running') AND instr(spec, ?) > 0");
    row.bind(1, sha256);
    return row.executeStep();
}

}  // namespace

Asset SqliteAssets::read_asset(SQLite::Statement& row) const {
    Asset asset{.sha256 = row.getColumn(0).getString(),
                .type = row.getColumn(1).getString(),
                .media_type = row.getColumn(2).getString(),
                .name = row.getColumn(3).getString(),
                .size_bytes = row.getColumn(4).getInt64(),
                .created_ms = row.getColumn(5).getInt64(),
                .facts = json::parse(row.getColumn(6).getString(), nullptr, false)};
    if (!asset.facts.is_object()) {
        asset.facts = json::object();
        asset.broken = "its facts cannot be read";
    }
    if (!m_archive.assets().find(asset.sha256)) asset.broken = "its file is missing";
    if (!asset.broken.empty()) spdlog::error("asset {}: {}", asset.sha256, asset.broken);
    return asset;
}

void SqliteAssets::add(const Asset& asset, const std::string& bytes) {
    if (const std::string lack = lack_of_room_after_tidying(m_archive); !lack.empty()) throw StoreFull(lack);
    m_archive.assets().put(asset.sha256, bytes);
    try {
        m_archive.write([&](SQLite::Database& database) {
            // A deletion may have removed the file before the write lock was held.
            if (!m_archive.assets().find(asset.sha256)) m_archive.assets().put(asset.sha256, bytes);
            SQLite::Statement insert(database,
                                     "INSERT INTO assets VALUES (?, ?, ?, ?, ?, ?, ?, '') ON CONFLICT DO NOTHING");
            SQLite::bind(insert, asset.sha256, asset.type, asset.media_type, asset.name, asset.size_bytes,
                         m_archive.now_ms(), asset.facts.dump());
            insert.exec();
            SQLite::Statement seal(database,
                                   "UPDATE assets SET seal = (SELECT seal FROM sealed_assets WHERE sha256 = ?1) "
                                   "WHERE sha256 = ?1 AND seal = ''");
            seal.bind(1, asset.sha256);
            seal.exec();
        });
    } catch (const StoreError&) {
        remove_file_without_row(asset.sha256);
        throw;
    }
    m_archive.checkpoint();
}

void SqliteAssets::remove_file_without_row(const std::string& sha256) {
    m_archive.essential([&](SQLite::Database& database) {
        SQLite::Statement row(database, "SELECT 1 FROM assets WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) m_archive.assets().remove(sha256);
    });
}

std::optional<OpenAsset> SqliteAssets::open(const std::string& sha256) {
    auto asset = find(sha256);
    if (!asset) return std::nullopt;
    try {
        return OpenAsset{std::move(*asset), m_archive.assets().open(sha256)};
    } catch (const DamagedData&) {
        // It may have been deleted in between.
        if (!find(sha256)) return std::nullopt;
        throw;
    }
}

std::optional<Asset> SqliteAssets::find(const std::string& sha256) {
    return m_archive.read([&](SQLite::Database& database) -> std::optional<Asset> {
        SQLite::Statement row(database, std::string(select_assets) + "WHERE sha256 = ?");
        row.bind(1, sha256);
        if (!row.executeStep()) return std::nullopt;
        return read_asset(row);
    });
}

std::vector<Asset> SqliteAssets::list(int limit) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement rows(database, std::string(select_assets) + "ORDER BY created_ms DESC, rowid DESC LIMIT ?");
        rows.bind(1, limit);
        std::vector<Asset> assets;
        while (rows.executeStep()) assets.push_back(read_asset(rows));
        return assets;
    });
}

Assets::Removal SqliteAssets::remove(const std::string& sha256) {
    if (!is_sha256(sha256)) return Removal::not_found;
    const Removal result = m_archive.essential([&](SQLite::Database& database) {
        if (is_waited_for(database, sha256)) return Removal::in_use;
        SQLite::Statement drop(database, "DELETE FROM assets WHERE sha256 = ?");
        drop.bind(1, sha256);
        if (drop.exec() == 0) return Removal::not_found;
        try_again_what_lacked_room(database);
        return Removal::removed;
    });
    if (result != Removal::removed) return result;
    // The row first, and the file after its commit, as with blobs: a crash may leave an extra file but never loses one.
    remove_file_without_row(sha256);
    m_archive.checkpoint();
    m_archive.room().restore_reserve();
    return result;
}

}  // namespace sheer
