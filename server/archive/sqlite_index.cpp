#include "server/archive/sqlite_index.h"

#include <SQLiteCpp/VariadicBind.h>

#include <algorithm>

#include "server/archive/facet_bits.h"
#include "server/archive/sqlite_functions.h"
#include "server/archive/sqlite_steps.h"
#include "server/jobs/search.h"

namespace sheer {

using nlohmann::json;

namespace {

/// -1 if it has none.
std::int64_t place_in(SQLite::Database& database, const std::string& id) {
    SQLite::Statement row(database, "SELECT place FROM search_lines WHERE report_id = ?");
    row.bind(1, id);
    return row.executeStep() ? row.getColumn(0).getInt64() : -1;
}

std::int64_t free_place(SQLite::Database& database, const std::string& id) {
    SQLite::Statement row(database, "SELECT 1 FROM search_lines WHERE place = ?");
    for (auto place = std::max<std::int64_t>(place_of(id), 1);; ++place) {
        row.bind(1, place);
        const bool is_taken = row.executeStep();
        row.reset();
        if (!is_taken) return place;
    }
}

void add_facets(SQLite::Database& database, std::int64_t place, const std::vector<std::string>& texts) {
    SQLite::Statement name(database, "INSERT INTO facets (facet) VALUES (?) ON CONFLICT DO NOTHING");
    SQLite::Statement link(database,
                           "INSERT INTO report_facets SELECT id, ? FROM facets WHERE facet = ? ON CONFLICT DO NOTHING");
    for (const std::string& text : texts) {
        name.bind(1, text);
        name.exec();
        name.reset();
        SQLite::bind(link, place, text);
        link.exec();
        link.reset();
    }
}

std::string line_words(const Facets& facets) {
    std::string line;
    for (const std::string& word : search_words(facets)) line += " " + word;
    return line;
}

std::vector<std::string> all_facet_texts(const IndexedReport& report) {
    std::vector<std::string> texts = facet_texts(report.facets, report.spec_sha256);
    texts.push_back(status_facet_text(report.status));
    if (report.status != Status::done) return texts;
    for (std::string& text : outcome_facet_texts(report.verdict, report.device)) texts.push_back(std::move(text));
    return texts;
}

std::string device_in(SQLite::Statement& row, const std::string& id) {
    try {
        return renderer_of(json::parse(document_in(row.getColumn(4), row.getColumn(5), id), nullptr, false));
    } catch (const StoreError&) {
        return "";
    }
}

}  // namespace

void add_to_index(SQLite::Database& database, const IndexedReport& report) {
    const std::int64_t place = free_place(database, report.id);
    SQLite::Statement line(database,
                           "INSERT INTO search_lines SELECT ?, ?, ?, ?, coalesce(max(slot), -1) + 1 FROM search_lines");
    SQLite::bind(line, place, report.id, report.device, line_words(report.facets));
    line.exec();
    add_facets(database, place, all_facet_texts(report));
}

void add_outcome_to_index(SQLite::Database& database, const std::string& id, const std::string& verdict,
                          const std::string& device) {
    SQLite::Statement name(database, "UPDATE search_lines SET device = ? WHERE report_id = ?");
    SQLite::bind(name, device, id);
    name.exec();
    add_facets(database, place_in(database, id), outcome_facet_texts(verdict, device));
}

IndexedReport indexed_report(SQLite::Database& database, const std::string& id) {
    SQLite::Statement row(database,
                          "SELECT status, spec, spec_sha256, coalesce(verdict, ''), sha256, packed FROM reports "
                          "LEFT JOIN documents ON report_id = id WHERE id = ?");
    row.bind(1, id);
    if (!row.executeStep()) throw StoreError("there is no report " + id);
    IndexedReport report{.id = id, .status = status_of(row.getColumn(0))};
    report.facets = facets_of(json::parse(row.getColumn(1).getString(), nullptr, false));
    report.spec_sha256 = row.getColumn(2).getString();
    report.verdict = row.getColumn(3).getString();
    if (report.status == Status::done) report.device = device_in(row, id);
    return report;
}

bool is_indexed(SQLite::Database& database, const IndexedReport& report) {
    SQLite::Statement line(database, "SELECT place, device, words FROM search_lines WHERE report_id = ?");
    line.bind(1, report.id);
    if (!line.executeStep() || line.getColumn(1).getString() != report.device ||
        line.getColumn(2).getString() != line_words(report.facets))
        return false;
    SQLite::Statement rows(database,
                           "SELECT f.facet FROM report_facets r JOIN facets f ON f.id = r.facet WHERE r.place = ?");
    rows.bind(1, line.getColumn(0).getInt64());
    std::vector<std::string> there, wanted = all_facet_texts(report);
    while (rows.executeStep()) there.push_back(rows.getColumn(0).getString());
    std::ranges::sort(there);
    std::ranges::sort(wanted);
    return there == wanted;
}

void rebuild_index(SQLite::Database& database) {
    database.exec("DELETE FROM search_lines; DELETE FROM report_facets; UPDATE facets SET reports = 0");
    rebuild_facet_bits(database);
    database.exec("INSERT INTO search_words (search_words) VALUES ('rebuild')");
    std::vector<std::string> ids;
    SQLite::Statement rows(database, "SELECT id FROM reports ORDER BY id");
    while (rows.executeStep()) ids.push_back(rows.getColumn(0).getString());
    for (const std::string& id : ids) add_to_index(database, indexed_report(database, id));
}

}  // namespace sheer
