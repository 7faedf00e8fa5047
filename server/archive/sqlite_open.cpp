#include "server/archive/sqlite_open.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>

#include "server/archive/sqlite_functions.h"
#include "server/jobs/store_errors.h"

namespace sheer {

namespace fs = std::filesystem;

namespace {

constexpr int busy_timeout_ms = 10'000;
constexpr std::uintmax_t largest_checked_bytes = std::uintmax_t{16} << 20;
constexpr std::size_t header_bytes = 100;

std::uintmax_t size_or_zero(const fs::path& file) {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(file, none);
    return none ? 0 : size;
}

bool holds_files(const fs::path& folder) {
    std::error_code none;
    return std::ranges::any_of(fs::recursive_directory_iterator(folder, none),
                               [](const fs::directory_entry& entry) { return entry.is_regular_file(); });
}

std::uint32_t big_endian(const char* bytes, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

/// The first bytes, by SQLite: if this process opened the file itself, closing it would drop the locks of all its
/// connections (POSIX advisory locks), and the next process that ends would delete the log under them.
std::array<char, header_bytes> header_of(const fs::path& file) {
    std::array<char, header_bytes> header{};
    const SQLite::Database unread(file.string(), SQLite::OPEN_READONLY);
    sqlite3_file* opened = nullptr;
    if (sqlite3_file_control(unread.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &opened) == SQLITE_OK &&
        opened->pMethods != nullptr)
        opened->pMethods->xRead(opened, header.data(), static_cast<int>(header.size()), 0);
    return header;
}

/// How long the file must be according to its header (the SQLite file format, 1.3); 0 if it is not a database.
std::uintmax_t size_by_header(const fs::path& file) {
    const std::array<char, header_bytes> header = header_of(file);
    if (std::string_view(header.data(), 16) != std::string_view("SQLite format 3\0", 16)) return 0;
    const std::uint32_t page_bytes = big_endian(&header[16], 2);
    return std::uintmax_t{page_bytes == 1 ? 65536 : page_bytes} * big_endian(&header[28], 4);
}

/// Checks the files before SQLite opens them: it takes an empty file for a new database, and notices late that one is
/// truncated.
void check_files(const DataFolder& folder) {
    const fs::path file = folder.database(), log = file.string() + "-wal";
    const std::uintmax_t size = size_or_zero(file), log_size = size_or_zero(log);
    if (size == 0) {
        const bool orphaned = log_size > 0 || holds_files(folder.blobs()) || holds_files(folder.assets());
        if (!orphaned) return;
        throw StoreError(
            fmt::format("{} is {}, but {} holds the files of an archive; put the database back, or choose "
                        "another folder",
                        file.string(), fs::exists(file) ? "empty" : "missing", folder.root.string()));
    }
    const std::uintmax_t wanted = size_by_header(file);
    if (wanted == 0) throw StoreError(fmt::format("{} is not a SQLite database", file.string()));
    // If the log has not been written to the database yet, the file may be shorter.
    if (size < wanted && log_size == 0)
        throw StoreError(fmt::format("{} is truncated: it has {} of {} bytes", file.string(), size, wanted));
}

/// A database of ours has our application id; older ones, from before there was an id, are recognized by their tables.
void check_identity(SQLite::Database& database, const DataFolder& folder) {
    const std::int64_t id = database.execAndGet("PRAGMA application_id").getInt64();
    if (id == archive_application_id) return;
    const std::int64_t version = database.execAndGet("PRAGMA user_version").getInt64();
    const int tables = database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt();
    const int ours = database
                         .execAndGet(
                             "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('reports', "
                             "'report_methods', 'report_tags', 'report_blobs', 'blobs', 'health')")
                         .getInt();
    if (id == 0 && version > 0 && ours == 6) return;
    const fs::path file = folder.database();
    if (id != 0 || version != 0 || tables != 0)
        throw StoreError(fmt::format("{} is a database of another program", file.string()));
    if (holds_files(folder.blobs()) || holds_files(folder.assets()))
        throw StoreError(
            fmt::format("{} has no tables, but {} holds the files of an archive", file.string(), folder.root.string()));
}

}  // namespace

SQLite::Database open_archive(const DataFolder& folder) {
    try {
        fs::create_directories(folder.root);
        check_files(folder);
        SQLite::Database database(folder.database().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                                  busy_timeout_ms);
        check_identity(database, folder);
        add_functions(database);
        database.exec("PRAGMA journal_mode = WAL");
        database.exec("PRAGMA synchronous = FULL");
        database.exec("PRAGMA foreign_keys = ON");
        // So that the log does not fill a small disk: 512 KiB.
        database.exec("PRAGMA wal_autocheckpoint = 128");
        database.exec("PRAGMA journal_size_limit = 524288");
        return database;
    } catch (const StoreError&) {
        throw;
    } catch (const SQLite::Exception& error) {
        const std::string text = fmt::format("cannot open {}: {}", folder.database().string(), error.what());
        if (error.getErrorCode() == SQLITE_FULL) throw StoreFull(text);
        throw StoreError(text);
    } catch (const std::exception& error) {
        throw StoreError(fmt::format("cannot open the archive in {}: {}", folder.root.string(), error.what()));
    }
}

SQLite::Database open_reader(const DataFolder& folder) {
    SQLite::Database database = open_archive(folder);
    database.exec("PRAGMA query_only = ON");
    return database;
}

void check_archive(SQLite::Database& database, const DataFolder& folder) {
    const fs::path file = folder.database();
    if (size_or_zero(file) > largest_checked_bytes) return;
    std::string found;
    try {
        found = database.execAndGet("PRAGMA quick_check(1)").getString();
    } catch (const SQLite::Exception& error) {
        found = error.what();
    }
    if (found != "ok") throw StoreError(fmt::format("{} is damaged: {}", file.string(), found));
}

}  // namespace sheer
