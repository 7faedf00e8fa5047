#include "server/archive/list_query.h"

#include <algorithm>

#include "server/archive/sqlite_functions.h"
#include "server/jobs/search.h"

namespace sheer {

namespace {

/// Longer beginnings of words are not in the index (search.sql).
constexpr std::size_t longest_indexed_bytes = 8;

std::int64_t place_before(SQLite::Database& database, const std::string& id) {
    SQLite::Statement row(database, "SELECT place FROM search_lines WHERE report_id = ?");
    row.bind(1, id);
    // A report that was deleted since the last page.
    return row.executeStep() ? row.getColumn(0).getInt64() : place_of(id);
}

std::string fts_query(const std::vector<std::string>& words) {
    std::string query;
    for (const std::string& word : words)
        query += (query.empty() ? "\"" : " AND \"") + word.substr(0, longest_indexed_bytes) + "\"*";
    return query;
}

}  // namespace

void ListSql::bind(SQLite::Statement& statement) const {
    int index = 0;
    for (const auto& value : values) std::visit([&](const auto& each) { statement.bind(++index, each); }, value);
}

ListQuery::ListQuery(SQLite::Database& database, const ListFilter& filter, std::size_t few)
    : m_database(database), m_limit(filter.limit), m_few(few), m_words(words_of(filter.q)) {
    find_facets(filter);
    if (!filter.q.empty() && m_words.empty()) m_matches_nothing = true;
    if (filter.since_ms) m_times.from = place_at(*filter.since_ms);
    if (filter.until_ms) m_times.before = place_at(*filter.until_ms + 1);
    if (!filter.before_id.empty()) m_before_place = place_before(database, filter.before_id);
}

void ListQuery::find_facets(const ListFilter& filter) {
    std::vector<std::pair<std::int64_t, std::int64_t>> found;  // how many reports, facet
    SQLite::Statement row(m_database, "SELECT reports, id FROM facets WHERE facet = ?");
    for (const std::string& text : wanted_facet_texts(filter)) {
        row.bind(1, text);
        if (!row.executeStep()) {
            m_matches_nothing = true;
            return;
        }
        found.emplace_back(row.getColumn(0).getInt64(), row.getColumn(1).getInt64());
        row.reset();
    }
    std::ranges::sort(found);
    for (const auto& [reports, facet] : found) m_facets.push_back(facet);
    if (!found.empty()) m_rarest = found.front().first;
}

ListSql ListQuery::statement(PlaceRange range) const {
    ListSql sql;
    std::string place = "place";
    if (!m_words.empty()) {
        place = "rowid";
        sql.text = "SELECT rowid FROM search_words WHERE search_words MATCH ?";
        sql.values.emplace_back(fts_query(m_words));
    } else if (!m_facets.empty()) {
        sql.text = "SELECT place FROM report_facets WHERE facet = ?";
        sql.values.emplace_back(m_facets.front());
    } else {
        sql.text = "SELECT place FROM search_lines WHERE 1";
    }
    sql.text += " AND " + place + " >= ? AND " + place + " < ? ORDER BY " + place + " DESC";
    sql.values.emplace_back(range.from);
    sql.values.emplace_back(range.before);
    return sql;
}

bool ListQuery::has_words(SQLite::Statement& line, std::int64_t place) const {
    line.bind(1, place);
    const std::string words = line.executeStep() ? line.getColumn(0).getString() : "";
    line.reset();
    return std::ranges::all_of(m_words,
                               [&](const std::string& word) { return words.find(" " + word) != std::string::npos; });
}

std::vector<std::int64_t> ListQuery::newest_with_words(PlaceRange range, std::size_t limit) const {
    std::vector<std::int64_t> found;
    SQLite::Statement line(m_database, "SELECT words FROM search_lines WHERE place = ?");
    std::vector<std::int64_t> candidates;
    if (!m_facets.empty()) {
        candidates = newest_with_all(m_database, m_facets, range, SIZE_MAX);
        if (candidates.size() <= m_few) {
            for (const std::int64_t place : candidates)
                if (found.size() < limit && has_words(line, place)) found.push_back(place);
            return found;
        }
    }
    const bool is_indexed =
        std::ranges::all_of(m_words, [](const std::string& word) { return word.size() <= longest_indexed_bytes; });
    const ListSql sql = statement(range);
    SQLite::Statement rows(m_database, sql.text);
    sql.bind(rows);
    for (auto next = candidates.begin(); found.size() < limit && rows.executeStep();) {
        const std::int64_t place = rows.getColumn(0).getInt64();
        if (!m_facets.empty()) {
            while (next != candidates.end() && *next > place) ++next;
            if (next == candidates.end()) break;
            if (*next != place) continue;
        }
        if (is_indexed || has_words(line, place)) found.push_back(place);
    }
    return found;
}

std::vector<std::int64_t> ListQuery::newest(PlaceRange range, std::size_t limit) const {
    if (m_matches_nothing) return {};
    if (!m_words.empty()) return newest_with_words(range, limit);
    if (m_facets.size() > 1) return newest_with_all(m_database, m_facets, range, limit);
    const ListSql sql = statement(range);
    SQLite::Statement rows(m_database, sql.text);
    sql.bind(rows);
    std::vector<std::int64_t> places;
    while (places.size() < limit && rows.executeStep()) places.push_back(rows.getColumn(0).getInt64());
    return places;
}

std::vector<std::int64_t> ListQuery::page() const {
    return newest({m_times.from, std::min(m_times.before, m_before_place)}, static_cast<std::size_t>(m_limit) + 1);
}

std::vector<std::int64_t> ListQuery::first_places() const {
    return newest(m_times, max_exact_count + 1);
}

bool ListQuery::counts_by_reading() const {
    const bool is_at_any_time = m_times.from == 0 && m_times.before == INT64_MAX;
    return m_matches_nothing || !m_words.empty() || !is_at_any_time || m_facets.size() > 1;
}

std::int64_t ListQuery::known_count() const {
    if (m_facets.size() == 1) return m_rarest;
    return m_database.execAndGet("SELECT sum(reports) FROM facets WHERE id <= 5").getInt64();
}

}  // namespace sheer
