#include "server/archive/archive_copy.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "server/archive/sqlite_archive.h"
#include "server/archive/sqlite_functions.h"
#include "server/archive/sqlite_open.h"
#include "server/jobs/limits.h"
#include "server/storage/content_folder.h"

namespace sheer {

namespace fs = std::filesystem;

namespace {

constexpr int all_pages = -1;

void copy_database(const DataFolder& from, const DataFolder& to) {
    SQLite::Database source = open_reader(from);
    SQLite::Database copy(to.database().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    // All pages in one step, which reads one state and lets others write meanwhile.
    SQLite::Backup(copy, source).executeStep(all_pages);
    // So that it is one file, which can be read where nothing can be written.
    copy.exec("PRAGMA journal_mode = DELETE");
}

std::vector<std::string> names_in(SQLite::Database& database, const std::string& table) {
    std::vector<std::string> names;
    SQLite::Statement rows(database, fmt::format("SELECT sha256 FROM {}", table));
    while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
    return names;
}

bool has_row(SQLite::Database& database, const std::string& table, const std::string& sha256) {
    SQLite::Statement row(database, fmt::format("SELECT 1 FROM {} WHERE sha256 = ?", table));
    row.bind(1, sha256);
    return row.executeStep();
}

void execute(SQLite::Database& database, const std::string& sql, const std::string& value) {
    SQLite::Statement statement(database, sql);
    statement.bind(1, value);
    statement.exec();
}

/// What was deleted from the source after its database was copied is deleted from the copy as well.
void delete_from_copy(SQLite::Database& copy, const std::string& table, const std::string& sha256) {
    if (table == "assets") return execute(copy, "DELETE FROM assets WHERE sha256 = ?", sha256);
    for (const char* dependent : {"baselines", "pins"})
        execute(copy,
                fmt::format("DELETE FROM {} WHERE report_id IN (SELECT report_id FROM report_blobs WHERE sha256 = ?)",
                            dependent),
                sha256);
    execute(copy, "DELETE FROM reports WHERE id IN (SELECT report_id FROM report_blobs WHERE sha256 = ?)", sha256);
    execute(copy, "DELETE FROM blobs WHERE sha256 = ?", sha256);
}

struct Files {
    const char* table;
    fs::path from, to;
};

/// Returns how many it copied.
std::int64_t copy_files(SQLite::Database& source, SQLite::Database& copy, const Files& files, BackupResult& result) {
    const ContentFolder from(files.from);
    ContentFolder to(files.to);
    to.make();
    std::int64_t copied = 0;
    for (const std::string& sha256 : names_in(copy, files.table)) {
        try {
            const ContentPtr content = from.open(sha256);
            to.put(sha256, read_all(*content, max_picture_bytes));
            result.bytes += content->size_bytes();
            ++copied;
        } catch (const DamagedData& damaged) {
            if (has_row(source, files.table, sha256)) {
                result.damaged.emplace_back(damaged.what());
            } else {
                delete_from_copy(copy, files.table, sha256);
            }
        }
    }
    return copied;
}

}  // namespace

void require_empty(const fs::path& folder) {
    std::error_code error;
    if (fs::exists(folder, error) && !fs::is_empty(folder, error))
        throw StoreError(fmt::format("{} is not empty", folder.string()));
    if (error) throw StoreError(fmt::format("cannot examine {}: {}", folder.string(), error.message()));
}

BackupResult copy_archive(const DataFolder& from, const DataFolder& to) {
    require_empty(to.root);
    // A folder without an archive must not get one by being opened.
    if (!fs::is_regular_file(from.database()))
        throw StoreError(fmt::format("there is no archive in {}", from.root.string()));
    try {
        fs::create_directories(to.root);
        copy_database(from, to);
        SQLite::Database source = open_reader(from);
        SQLite::Database copy(to.database().string(), SQLite::OPEN_READWRITE);
        add_functions(copy);
        copy.exec("PRAGMA foreign_keys = ON");
        BackupResult result;
        result.pictures = copy_files(source, copy, {"blobs", from.blobs(), to.blobs()}, result);
        result.uploads = copy_files(source, copy, {"assets", from.assets(), to.assets()}, result);
        result.reports = copy.execAndGet("SELECT count(*) FROM reports WHERE finished_ms IS NOT NULL").getInt64();
        std::error_code none;
        result.bytes += fs::file_size(to.database(), none);
        return result;
    } catch (const SQLite::Exception& error) {
        throw_store_error(error);
    } catch (const fs::filesystem_error& error) {
        if (means_full_disk(error.code())) throw StoreFull("the disk of the copy is full");
        throw DiskError(error.what());
    }
}

}  // namespace sheer
