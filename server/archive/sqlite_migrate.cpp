#include "server/archive/sqlite_migrate.h"

#include <SQLiteCpp/VariadicBind.h>
#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "embedded_server_files.h"
#include "server/archive/facet_bits.h"
#include "server/archive/sqlite_index.h"
#include "server/archive/sqlite_open.h"
#include "server/jobs/store_errors.h"
#include "server/storage/content_folder.h"

namespace sheer {

namespace {

/// Turns an archive of one version into one of the next: by SQL, and then by what SQL cannot do.
struct Migration {
    const char* file;
    void (*then)(SQLite::Database& database, const DataFolder& folder) = nullptr;
};

/// The index of words and facets is written as version 11 has it, so it is made for archives of versions before 6 here.
void index_all(SQLite::Database& database, const DataFolder&) {
    const bool is_there = database.execAndGet("SELECT EXISTS (SELECT 1 FROM search_lines)").getInt() != 0;
    if (is_there)
        rebuild_facet_bits(database);
    else
        rebuild_index(database);
}

void measure_blobs(SQLite::Database& database, const DataFolder& folder) {
    const ContentFolder blobs(folder.blobs());
    std::vector<std::string> all;
    SQLite::Statement rows(database, "SELECT sha256 FROM blobs");
    while (rows.executeStep()) all.push_back(rows.getColumn(0).getString());
    SQLite::Statement note(database, "UPDATE blobs SET size_bytes = ? WHERE sha256 = ?");
    for (const std::string& sha256 : all) {
        SQLite::bind(note, blobs.size_bytes(sha256), sha256);
        note.exec();
        note.reset();
    }
}

constexpr std::array<Migration, 13> migrations = {{{"schema.sql"},
                                                   {"assets.sql"},
                                                   {"retries.sql"},
                                                   {"baselines.sql"},
                                                   {"documents.sql"},
                                                   {"search.sql"},
                                                   {"care.sql", measure_blobs},
                                                   {"trends.sql"},
                                                   {"metrics.sql"},
                                                   {"workers.sql"},
                                                   {"facet_bits.sql", index_all},
                                                   {"quotas.sql"},
                                                   {"parts.sql"}}};

std::string sql_file(const std::string& name) {
    for (const EmbeddedFile& file : embedded_server_files())
        if (file.path == name) return std::string(file.bytes);
    throw StoreError("the program was built without " + name);
}

}  // namespace

std::int64_t archive_version() {
    return static_cast<std::int64_t>(migrations.size());
}

void migrate_archive(SQLite::Database& database, const DataFolder& folder) {
    const auto version = database.execAndGet("PRAGMA user_version").getInt64();
    if (version < 0 || version > archive_version())
        throw StoreError(fmt::format("the archive in {} has version {}, but this program knows only version {}",
                                     folder.root.string(), version, archive_version()));
    for (auto i = static_cast<std::size_t>(version); i < migrations.size(); ++i) {
        database.exec(sql_file(migrations[i].file));
        if (migrations[i].then) migrations[i].then(database, folder);
    }
    database.exec(fmt::format("PRAGMA user_version = {}", archive_version()));
    database.exec(fmt::format("PRAGMA application_id = {}", archive_application_id));
}

}  // namespace sheer
