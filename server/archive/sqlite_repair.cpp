#include "server/archive/sqlite_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/core/clock.h"
#include "server/archive/sqlite_index.h"
#include "server/jobs/limits.h"
#include "server/storage/packed_text.h"

namespace sheer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::string in_hex(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    return text;
}

bool is_utf8(const std::string& bytes) {
    try {
        json(bytes).dump();
        return true;
    } catch (const json::exception&) {
        return false;
    }
}

/// A value as JSON; bytes, and texts that are not UTF-8, in hex.
json value_of(const SQLite::Column& column) {
    if (column.isNull()) return nullptr;
    if (column.isInteger()) return column.getInt64();
    if (column.isFloat()) return column.getDouble();
    const std::string bytes = column.getString();
    if (column.isText() && is_utf8(bytes)) return bytes;
    return {{"hex", in_hex(bytes)}};
}

json rows_of(SQLite::Database& database, const std::string& table, const std::string& key, const std::string& id) {
    json all = json::array();
    SQLite::Statement rows(database, fmt::format("SELECT * FROM {} WHERE {} = ?", table, key));
    rows.bind(1, id);
    while (rows.executeStep()) {
        json row = json::object();
        for (int i = 0; i < rows.getColumnCount(); ++i) row[rows.getColumnName(i)] = value_of(rows.getColumn(i));
        all.push_back(std::move(row));
    }
    return all;
}

class Quarantine {
  public:
    Quarantine(const DataFolder& data, std::int64_t now_ms) : m_data(data) {
        std::string name = utc_text(now_ms);
        std::ranges::replace(name, ':', '-');
        m_folder = data.quarantine() / name;
    }

    /// Returns its new place, relative to the data folder.
    std::string take(const fs::path& file) {
        const fs::path place = m_folder / file.lexically_relative(m_data.root);
        fs::create_directories(place.parent_path());
        fs::rename(file, place);
        return place.lexically_relative(m_data.root).string();
    }

    std::string write(const fs::path& name, const std::string& text) {
        const fs::path place = m_folder / name;
        fs::create_directories(place.parent_path());
        std::ofstream file(place, std::ios::binary);
        file << text;
        if (!file.flush()) throw DiskError(fmt::format("cannot write {}", place.string()));
        return place.lexically_relative(m_data.root).string();
    }

  private:
    const DataFolder m_data;
    fs::path m_folder;
};

constexpr const char* dependent_tables[] = {"documents",    "report_seals",   "report_methods", "report_tags",
                                            "report_blobs", "report_numbers", "baselines",      "pins"};

/// The rows of a report leave the database, once they are in the quarantine.
std::string set_aside(SQLite::Database& database, Quarantine& quarantine, const std::string& id) {
    json all = {{"reports", rows_of(database, "reports", "id", id)}};
    for (const char* table : dependent_tables) all[table] = rows_of(database, table, "report_id", id);
    const std::string place = quarantine.write(fs::path("reports") / (id + ".json"),
                                               all.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
    for (const char* statement : {"DELETE FROM baselines WHERE report_id = ?", "DELETE FROM pins WHERE report_id = ?",
                                  "DELETE FROM reports WHERE id = ?"}) {
        SQLite::Statement gone(database, statement);
        gone.bind(1, id);
        gone.exec();
    }
    return place;
}

}  // namespace

std::vector<std::string> repair_archive(SqliteArchive& archive, const DataFolder& folder, const SqliteCheck& check) {
    std::vector<std::string> done;
    Quarantine quarantine(folder, archive.now_ms());
    const auto attempt = [&](const std::string& what, const auto& work) {
        try {
            done.push_back(work());
        } catch (const std::exception& error) {
            done.push_back(fmt::format("{} cannot be repaired: {}", what, error.what()));
        }
    };
    const auto move_files = [&](const std::vector<fs::path>& files) {
        for (const fs::path& file : files)
            attempt(file.filename().string(), [&] { return fmt::format("moved to {}", quarantine.take(file)); });
    };
    move_files(check.damaged_files());
    move_files(check.unnamed_files());
    for (const std::string& id : check.broken_reports())
        attempt("report " + id, [&] {
            return archive.write([&](SQLite::Database& database) {
                return fmt::format("report {} is set aside in {}", id, set_aside(database, quarantine, id));
            });
        });
    if (check.index_is_wrong())
        attempt("the index", [&] {
            archive.write(rebuild_index);
            return std::string("the index for searching is made again");
        });
    archive.checkpoint();
    return done;
}

}  // namespace sheer
