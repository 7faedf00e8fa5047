#include "server/archive/sqlite_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/core/sha256.h"
#include "server/archive/facet_bits.h"
#include "server/archive/report_facts.h"
#include "server/archive/sqlite_functions.h"
#include "server/archive/sqlite_index.h"
#include "server/archive/sqlite_migrate.h"
#include "server/archive/sqlite_steps.h"
#include "server/jobs/search.h"

namespace sheer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// A file that nothing names may belong to a report that is being committed, if it is younger.
constexpr std::chrono::hours unnamed_age{1};

std::vector<std::string> texts_of(SQLite::Database& database, const std::string& sql) {
    std::vector<std::string> texts;
    SQLite::Statement rows(database, sql);
    while (rows.executeStep()) texts.push_back(rows.getColumn(0).getString());
    return texts;
}

/// The tables, indexes, views and triggers, except those of SQLite itself.
std::map<std::string, std::string> schema_of_database(SQLite::Database& database) {
    std::map<std::string, std::string> schema;
    // A text that a flipped bit has made a blob reads the same.
    SQLite::Statement rows(database,
                           "SELECT type || ' ' || name, types || ' ' || tbl_name || ' ' || coalesce(sql, '') "
                           "FROM (SELECT *, typeof(type) || typeof(name) || typeof(tbl_name) || typeof(sql) AS "
                           "types FROM sqlite_schema) WHERE name NOT LIKE 'sqlite\\_stat%' ESCAPE '\\'");
    while (rows.executeStep()) schema[rows.getColumn(0).getString()] = rows.getColumn(1).getString();
    return schema;
}

bool is_young(const fs::path& file) {
    std::error_code gone;
    const fs::file_time_type written = fs::last_write_time(file, gone);
    return gone || written > fs::file_time_type::clock::now() - unnamed_age;
}

}  // namespace

CheckResult SqliteCheck::run() {
    part("the database", [&] { check_database(); });
    part("the tables", [&] { check_schema(); });
    part("the reports", [&] { check_reports(); });
    part("the index", [&] { check_index(); });
    part("the baselines", [&] { check_seals("baselines", "report_id", "the acceptance of report"); });
    part("the pins", [&] { check_seals("pins", "report_id", "the pin of report"); });
    part("the numbers", [&] { check_seals("report_numbers", "report_id", "the numbers of report"); });
    part("the pictures", [&] { check_blobs(); });
    part("the uploads", [&] { check_assets(); });
    part("the files", [&] {
        check_files(m_archive.blobs(), m_folder.blobs(), "blobs");
        check_files(m_archive.assets(), m_folder.assets(), "assets");
    });
    part("the scratch folder", [&] { check_scratch(); });
    return m_result;
}

void SqliteCheck::part(const std::string& name, const std::function<void()>& check) {
    try {
        check();
    } catch (const std::exception& error) {
        add(Kind::damage, fmt::format("{} cannot be read: {}", name, error.what()));
    }
}

void SqliteCheck::check_database() {
    constexpr std::size_t most_findings = 100;
    const auto found = m_archive.read([&](SQLite::Database& database) {
        return texts_of(database, fmt::format("PRAGMA integrity_check({})", most_findings));
    });
    for (const std::string& text : found)
        if (text != "ok") add(Kind::damage, "the database: " + text);
    const auto references =
        m_archive.read([](SQLite::Database& database) { return texts_of(database, "PRAGMA foreign_key_check"); });
    for (const std::string& table : references)
        add(Kind::damage, fmt::format("a row of the table {} refers to one that is missing", table));
}

void SqliteCheck::check_schema() {
    SQLite::Database wanted(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    add_functions(wanted);
    migrate_archive(wanted, m_folder);
    const auto there = m_archive.read(schema_of_database), expected = schema_of_database(wanted);
    for (const auto& [name, sql] : expected)
        if (!there.contains(name) || there.at(name) != sql)
            add(Kind::damage, fmt::format("the {} of the database is missing or has another definition", name));
    for (const auto& [name, sql] : there)
        if (!expected.contains(name)) add(Kind::damage, fmt::format("the {} of the database is not ours", name));
}

void SqliteCheck::check_reports() {
    const auto ids =
        m_archive.read([](SQLite::Database& database) { return texts_of(database, "SELECT id FROM reports"); });
    for (const std::string& id : ids) {
        try {
            m_archive.read([&](SQLite::Database& database) {
                SQLite::Transaction one_state(database, SQLite::TransactionBehavior::DEFERRED);
                check_report(database, id);
            });
        } catch (const std::exception& error) {
            add(Kind::damage, fmt::format("report {} cannot be read: {}", id, error.what()));
            m_broken_reports.push_back(id);
        }
        ++m_result.reports;
    }
}

void SqliteCheck::check_report(SQLite::Database& database, const std::string& id) {
    const ReportFacts facts(database, id);
    if (!facts.exists()) return;
    std::vector<std::string> wrong = facts.wrong_contents();
    if (!wrong.empty()) m_broken_reports.push_back(id);
    for (std::string& text : facts.wrong_relations()) wrong.push_back(std::move(text));
    for (const std::string& text : wrong) add(Kind::damage, fmt::format("report {}: {}", id, text));
    if (wrong.empty() && !is_indexed(database, indexed_report(database, id))) {
        add(Kind::damage, fmt::format("report {}: it is not in the index for searching as it should be", id));
        m_index_is_wrong = true;
    }
}

void SqliteCheck::check_index() {
    m_archive.write([&](SQLite::Database& database) {
        try {
            database.exec("INSERT INTO search_words (search_words, rank) VALUES ('integrity-check', 1)");
        } catch (const SQLite::Exception&) {
            add(Kind::damage, "the index of words does not agree with the reports");
            m_index_is_wrong = true;
        }
        for (const std::string& facet :
             texts_of(database,
                      "SELECT facet FROM facets f WHERE reports <> (SELECT count(*) FROM report_facets WHERE facet = "
                      "f.id)")) {
            add(Kind::damage, fmt::format("the count of the reports with {} is wrong", words_of(facet).front()));
            m_index_is_wrong = true;
        }
        if (!facet_bits_are_right(database)) {
            add(Kind::damage, "the bits of the facets do not agree with the reports");
            m_index_is_wrong = true;
        }
        constexpr Status all[] = {Status::queued, Status::running, Status::done, Status::failed, Status::cancelled};
        const auto statuses = texts_of(database, "SELECT facet FROM facets WHERE id <= 5 ORDER BY id");
        if (!std::ranges::equal(statuses, all, {}, {}, status_facet_text))
            add(Kind::damage, "the facets of the statuses are not there");
        const auto extra =
            texts_of(database, "SELECT report_id FROM search_lines WHERE report_id NOT IN (SELECT id FROM reports)");
        for (const std::string& id : extra)
            add(Kind::damage, fmt::format("the index for searching has a report {} that does not exist", id));
        const auto unused = database.execAndGet("SELECT count(*) FROM facets WHERE id > 5 AND reports = 0").getInt64();
        if (unused > 0) add(Kind::leftover, fmt::format("{} facets that no report has any more", unused));
    });
}

void SqliteCheck::check_seals(const std::string& table, const std::string& key, const std::string& what) {
    const std::string same_key =
        table == "baselines" ? "s.name = t.name AND s.report_id = t.report_id" : fmt::format("s.{0} = t.{0}", key);
    const auto wrong = m_archive.read([&](SQLite::Database& database) {
        return texts_of(database, fmt::format("SELECT t.{0} FROM {1} t JOIN sealed_{1} s ON {2} WHERE s.seal <> t.seal",
                                              key, table, same_key));
    });
    for (const std::string& each : wrong) add(Kind::damage, fmt::format("{} {} was changed", what, each));
}

void SqliteCheck::check_blobs() {
    struct Row {
        std::string sha256;
        std::int64_t size_bytes;
        bool is_named;
    };
    const auto all = m_archive.read([&](SQLite::Database& database) {
        std::vector<Row> found;
        SQLite::Statement rows(database,
                               "SELECT sha256, size_bytes, EXISTS (SELECT 1 FROM report_blobs r WHERE r.sha256 = "
                               "b.sha256) FROM blobs b");
        while (rows.executeStep())
            found.push_back(
                {rows.getColumn(0).getString(), rows.getColumn(1).getInt64(), rows.getColumn(2).getInt() != 0});
        return found;
    });
    for (const Row& row : all) {
        ++m_result.pictures;
        if (!row.is_named) add(Kind::leftover, fmt::format("no report names the picture {}", row.sha256));
        check_file(m_archive.blobs(), row.sha256, row.size_bytes, "picture", "blobs");
    }
}

void SqliteCheck::check_assets() {
    check_seals("assets", "sha256", "the row of the upload");
    struct Row {
        std::string sha256;
        std::int64_t size_bytes;
    };
    const auto all = m_archive.read([&](SQLite::Database& database) {
        std::vector<Row> found;
        SQLite::Statement rows(database, "SELECT sha256, size_bytes FROM assets");
        while (rows.executeStep()) found.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getInt64()});
        return found;
    });
    for (const Row& row : all) {
        ++m_result.uploads;
        check_file(m_archive.assets(), row.sha256, row.size_bytes, "upload", "assets");
    }
}

void SqliteCheck::check_file(const ContentFolder& folder, const std::string& sha256, std::int64_t size_bytes,
                             const std::string& what, const std::string& table) {
    std::string wrong;
    try {
        const ContentPtr content = folder.open(sha256);
        m_result.bytes += content->size_bytes();
        if (static_cast<std::int64_t>(content->size_bytes()) == size_bytes) return;
        wrong = fmt::format("the database says that the {} {} has another size", what, sha256);
    } catch (const DamagedData& damaged) {
        wrong = fmt::format("{} {}: {}", what, sha256, damaged.what());
    }
    const bool is_still_wrong = m_archive.write([&](SQLite::Database& database) {
        SQLite::Statement row(database, fmt::format("SELECT size_bytes FROM {} WHERE sha256 = ?", table));
        row.bind(1, sha256);
        if (!row.executeStep()) return false;
        try {
            return static_cast<std::int64_t>(folder.open(sha256)->size_bytes()) != row.getColumn(0).getInt64();
        } catch (const DamagedData&) {
            return true;
        }
    });
    if (!is_still_wrong) return;
    add(Kind::damage, wrong);
    // One of another size is whole: only the row is wrong.
    if (const auto path = folder.find(sha256); path && !folder.is_whole(sha256)) m_damaged_files.push_back(*path);
}

void SqliteCheck::check_files(const ContentFolder& folder, const fs::path& root, const std::string& table) {
    std::error_code gone;
    for (fs::recursive_directory_iterator at(root, gone), end; !gone && at != end; at.increment(gone)) {
        std::error_code none;
        if (at->is_directory(none)) continue;
        const fs::path& path = at->path();
        const std::string name = path.filename().string();
        const bool is_in_place = folder.find(name) == path;
        if (is_in_place && has_row(table, name)) continue;
        if (is_young(path) && (!is_in_place || is_busy())) continue;
        if (is_in_place && has_row(table, name)) continue;
        m_unnamed_files.push_back(path);
        add(Kind::leftover,
            fmt::format("nothing refers to the file {}", path.lexically_relative(m_folder.root).string()));
    }
}

bool SqliteCheck::has_row(const std::string& table, const std::string& sha256) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Statement row(database, fmt::format("SELECT 1 FROM {} WHERE sha256 = ?", table));
        row.bind(1, sha256);
        return row.executeStep();
    });
}

bool SqliteCheck::is_busy() {
    return m_archive.read([](SQLite::Database& database) {
        return database.execAndGet("SELECT EXISTS (SELECT 1 FROM reports WHERE status = 'running')").getInt() != 0;
    });
}

void SqliteCheck::check_scratch() {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(m_folder.scratch(), none)) {
        if (is_busy() || is_young(entry.path())) continue;
        m_unnamed_files.push_back(entry.path());
        add(Kind::leftover, fmt::format("no job uses {}", entry.path().lexically_relative(m_folder.root).string()));
    }
}

}  // namespace sheer
