#include "server/postgres/postgres_content.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "renderer/core/sha256.h"
#include "server/postgres/postgres_steps.h"

namespace sheer::postgres {

using nlohmann::json;

namespace {

/// Bytes that were read from the database, which stay when they are deleted there.
class ReadContent : public Content {
  public:
    explicit ReadContent(std::string bytes) : m_bytes(std::move(bytes)) {}
    std::uint64_t size_bytes() const override { return m_bytes.size(); }
    void read(std::uint64_t offset, std::span<char> bytes) const override {
        if (offset > m_bytes.size() || bytes.size() > m_bytes.size() - offset)
            throw StoreError("more bytes are read than there are");
        std::copy_n(m_bytes.data() + offset, bytes.size(), bytes.data());
    }

  private:
    std::string m_bytes;
};

ContentPtr checked_content(std::string_view bytes, const std::string& sha256) {
    std::string copy(bytes);
    if (sha256_hex(copy) != sha256) throw DamagedData(fmt::format("the bytes of {} have another hash", sha256));
    return std::make_shared<ReadContent>(std::move(copy));
}

constexpr const char* select_assets =
    "SELECT sha256, type, media_type, name, size_bytes, created_ms, facts FROM assets ";

Asset asset_at(const Rows& rows, int row) {
    Asset asset{.sha256 = rows.text(row, 0),
                .type = rows.text(row, 1),
                .media_type = rows.text(row, 2),
                .name = rows.text(row, 3),
                .size_bytes = rows.integer(row, 4),
                .created_ms = rows.integer(row, 5),
                .facts = json::parse(rows.text(row, 6), nullptr, false)};
    if (asset.facts.is_object()) return asset;
    asset.facts = json::object();
    asset.broken = "its facts cannot be read";
    spdlog::error("asset {}: {}", asset.sha256, asset.broken);
    return asset;
}

}  // namespace

std::optional<Blob> PostgresBlobs::open(const std::string& sha256) {
    return m_database.read([&](Connection& connection) -> std::optional<Blob> {
        const Rows row = connection.run("SELECT media_type, bytes FROM blobs WHERE sha256 = $1", {sha256});
        if (row.empty()) return std::nullopt;
        return Blob{row.text(0, 0), checked_content(row.bytes(0, 1), sha256)};
    });
}

void PostgresAssets::add(const Asset& asset, const std::string& bytes) {
    if (sha256_hex(bytes) != asset.sha256) throw StoreError("the bytes of the upload " + asset.sha256 + " are others");
    m_database.write([&](Connection& connection) {
        if (const std::string lack = find_lack_of_room(connection); !lack.empty()) throw StoreFull(lack);
        connection.run(
            "INSERT INTO assets (sha256, type, media_type, name, size_bytes, created_ms, facts, bytes) VALUES ($1, $2, "
            "$3, "
            "$4, $5, now_ms(), $6, $7) ON CONFLICT (sha256) DO UPDATE SET bytes = excluded.bytes WHERE "
            "encode(sha256(assets.bytes), 'hex') <> assets.sha256",
            {asset.sha256, asset.type, asset.media_type, asset.name, asset.size_bytes, asset.facts.dump(),
             Bytes{bytes}});
    });
}

std::optional<Asset> PostgresAssets::find(const std::string& sha256) {
    return m_database.read([&](Connection& connection) -> std::optional<Asset> {
        const Rows row = connection.run(std::string(select_assets) + "WHERE sha256 = $1", {sha256});
        if (row.empty()) return std::nullopt;
        return asset_at(row, 0);
    });
}

std::optional<OpenAsset> PostgresAssets::open(const std::string& sha256) {
    auto asset = find(sha256);
    if (!asset) return std::nullopt;
    return m_database.read([&](Connection& connection) -> std::optional<OpenAsset> {
        const Rows row = connection.run("SELECT bytes FROM assets WHERE sha256 = $1", {sha256});
        if (row.empty()) return std::nullopt;
        return OpenAsset{*asset, checked_content(row.bytes(0, 0), sha256)};
    });
}

std::vector<Asset> PostgresAssets::list(int limit) {
    return m_database.read([&](Connection& connection) {
        const Rows rows = connection.run(std::string(select_assets) + "ORDER BY created_ms DESC, place DESC LIMIT $1",
                                         {std::int64_t{limit}});
        std::vector<Asset> assets;
        for (int i = 0; i < rows.count(); ++i) assets.push_back(asset_at(rows, i));
        return assets;
    });
}

Assets::Removal PostgresAssets::remove(const std::string& sha256) {
    if (!is_sha256(sha256)) return Removal::not_found;
    return m_database.write([&](Connection& connection) {
        // The whole spec is searched: no spec contains a SHA-256 by chance.
        const Rows waiting = connection.run(
            "SELECT FROM jobs JOIN reports ON id = report_id WHERE strpos(spec, $1) > 0 LIMIT 1", {sha256});
        if (!waiting.empty()) return Removal::in_use;
        if (connection.run("DELETE FROM assets WHERE sha256 = $1", {sha256}).changed() == 0) return Removal::not_found;
        try_again_what_lacked_room(connection);
        return Removal::removed;
    });
}

}  // namespace sheer::postgres
