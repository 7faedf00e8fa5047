#include "server/archive/sqlite_care.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "server/archive/archive_copy.h"
#include "server/archive/report_rows.h"
#include "server/archive/sqlite_check.h"
#include "server/archive/sqlite_repair.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t files_in_a_transaction = 100;

std::uint64_t size_of(const fs::path& file) {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(file, none);
    return none ? 0 : size;
}

/// What each report alone adds to the pictures of all newer ones.
std::map<std::string, std::uint64_t> picture_bytes_by_report(SQLite::Database& database) {
    std::map<std::string, std::uint64_t> bytes;
    SQLite::Statement rows(database,
                           "SELECT newest, sum(size_bytes) FROM (SELECT sha256, max(report_id) AS newest FROM "
                           "report_blobs GROUP BY sha256) JOIN blobs USING (sha256) GROUP BY newest");
    while (rows.executeStep())
        bytes[rows.getColumn(0).getString()] = static_cast<std::uint64_t>(rows.getColumn(1).getInt64());
    return bytes;
}

std::map<std::string, json> tags_by_report(SQLite::Database& database) {
    std::map<std::string, json> tags;
    SQLite::Statement rows(database, "SELECT report_id, name, value FROM report_tags");
    while (rows.executeStep())
        tags[rows.getColumn(0).getString()][rows.getColumn(1).getString()] = rows.getColumn(2).getString();
    return tags;
}

}  // namespace

CheckResult SqliteCare::check(bool repair) {
    SqliteCheck check(m_archive, m_folder);
    CheckResult found = check.run();
    if (!repair || found.findings.empty()) return found;
    CheckResult after = [&] {
        const auto repairs = repair_archive(m_archive, m_folder, check);
        CheckResult again = SqliteCheck(m_archive, m_folder).run();
        again.repairs = repairs;
        return again;
    }();
    return after;
}

Garbage SqliteCare::collect_garbage() {
    Garbage garbage;
    m_archive.essential([&](SQLite::Database& database) {
        garbage.rows = database.exec("DELETE FROM facets WHERE id > 5 AND reports = 0");
        garbage.rows += database.exec("DELETE FROM number_names WHERE id NOT IN (SELECT names FROM report_numbers)");
        garbage.rows += database.exec(
            "DELETE FROM blobs WHERE NOT EXISTS (SELECT 1 FROM report_blobs r WHERE r.sha256 = blobs.sha256)");
    });
    remove_unnamed(m_archive.blobs(), "blobs", garbage);
    remove_unnamed(m_archive.assets(), "assets", garbage);
    constexpr std::chrono::hours leftover_age{1};
    m_archive.blobs().remove_leftovers(leftover_age);
    m_archive.assets().remove_leftovers(leftover_age);
    m_archive.checkpoint();
    m_archive.room().restore_reserve();
    return garbage;
}

std::vector<std::string> SqliteCare::names_without_row(const ContentFolder& folder, const std::string& table) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement row(database, fmt::format("SELECT 1 FROM {} WHERE sha256 = ?", table));
        std::vector<std::string> names = folder.list();
        std::erase_if(names, [&](const std::string& name) {
            row.bind(1, name);
            const bool is_named = row.executeStep();
            row.reset();
            return is_named;
        });
        return names;
    });
}

/// Each file under the write lock: a report that is being committed has either its rows by then, or looks for its files
/// again when it gets the lock.
void SqliteCare::remove_unnamed(ContentFolder& folder, const std::string& table, Garbage& garbage) {
    const std::vector<std::string> names = names_without_row(folder, table);
    for (std::size_t begin = 0; begin < names.size(); begin += files_in_a_transaction) {
        m_archive.essential([&](SQLite::Database& database) {
            SQLite::Statement row(database, fmt::format("SELECT 1 FROM {} WHERE sha256 = ?", table));
            for (std::size_t i = begin; i < std::min(names.size(), begin + files_in_a_transaction); ++i) {
                row.bind(1, names[i]);
                const bool is_named = row.executeStep();
                row.reset();
                const auto path = folder.find(names[i]);
                if (is_named || !path) continue;
                garbage.bytes += size_of(*path);
                folder.remove(names[i]);
                ++garbage.files;
            }
        });
    }
}

BackupResult SqliteCare::back_up(const fs::path& folder) {
    return copy_archive(m_folder, DataFolder{folder});
}

std::vector<StoredReport> SqliteCare::stored_reports() {
    return m_archive.read([](SQLite::Database& database) {
        SQLite::Transaction one_state(database, SQLite::TransactionBehavior::DEFERRED);
        const auto pictures = picture_bytes_by_report(database);
        auto tags = tags_by_report(database);
        std::vector<StoredReport> all;
        SQLite::Statement rows(database,
                               "SELECT id, created_ms, length(spec) + coalesce(length(packed), 0), "
                               "id IN (SELECT report_id FROM pins) OR id IN (SELECT report_id FROM baselines) "
                               "FROM reports LEFT JOIN documents ON report_id = id WHERE finished_ms IS NOT NULL "
                               "ORDER BY id DESC");
        while (rows.executeStep()) {
            StoredReport report{.id = rows.getColumn(0).getString(), .created_ms = rows.getColumn(1).getInt64()};
            report.bytes = static_cast<std::uint64_t>(rows.getColumn(2).getInt64());
            report.is_kept = rows.getColumn(3).getInt() != 0;
            if (const auto own = pictures.find(report.id); own != pictures.end()) report.bytes += own->second;
            if (const auto own = tags.find(report.id); own != tags.end()) report.tags = std::move(own->second);
            all.push_back(std::move(report));
        }
        return all;
    });
}

Care::Import SqliteCare::import_report(const ImportedReport& report) {
    if (const std::string lack = lack_of_room_after_tidying(m_archive); !lack.empty()) throw StoreFull(lack);
    std::vector<std::string> added;
    const auto put = [&](const BlobName& blob) {
        if (m_archive.blobs().put(blob.sha256, report.finished.read_blob(blob.sha256))) added.push_back(blob.sha256);
    };
    Import result = Import::added;
    try {
        for (const BlobName& blob : report.finished.blobs) put(blob);
        result = m_archive.write([&](SQLite::Database& database) {
            SQLite::Statement known(database,
                                    "SELECT sha256 FROM reports LEFT JOIN documents ON report_id = id "
                                    "WHERE id = ?");
            known.bind(1, report.id);
            SQLite::Statement hash(database, "SELECT sheer_sha256(?)");
            hash.bind(1, report.finished.report.dump());
            hash.executeStep();
            if (known.executeStep()) {
                if (known.getColumn(0).getString() != hash.getColumn(0).getString()) return Import::differs;
                return added.empty() ? Import::known : Import::restored;
            }
            for (const BlobName& blob : report.finished.blobs)
                if (!m_archive.blobs().find(blob.sha256)) put(blob);
            insert_report(database, {.id = report.id, .spec = report.spec, .spec_sha256 = report.spec_sha256},
                          report.created_ms);
            finish_report(database, m_blobs, report.id, report.finished);
            return Import::added;
        });
    } catch (const std::exception&) {
        m_blobs.remove_unnamed_files(added);
        throw;
    }
    if (result == Import::differs) m_blobs.remove_unnamed_files(added);
    m_archive.checkpoint();
    return result;
}

StoreSize SqliteCare::size() {
    StoreSize size = m_archive.read([](SQLite::Database& database) {
        StoreSize found;
        const auto number = [&](const char* sql) { return database.execAndGet(sql).getInt64(); };
        found.reports = number("SELECT count(*) FROM report_seals");
        found.pictures = number("SELECT count(*) FROM blobs");
        found.picture_bytes = static_cast<std::uint64_t>(number("SELECT coalesce(sum(size_bytes), 0) FROM blobs"));
        found.uploads = number("SELECT count(*) FROM assets");
        found.upload_bytes = static_cast<std::uint64_t>(number("SELECT coalesce(sum(size_bytes), 0) FROM assets"));
        return found;
    });
    for (const char* suffix : {"", "-wal"}) size.database_bytes += size_of(m_folder.database().string() + suffix);
    return size;
}

}  // namespace sheer
