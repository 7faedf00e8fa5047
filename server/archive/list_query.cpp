#include "server/archive/list_query.h"

#include <algorithm>

#include "server/archive/sqlite_functions.h"
#include "server/jobs/search.h"

namespace sheer {

namespace {

/// Reports of one facet whose words are compared one by one in less time than FTS5 needs for frequent words.
constexpr std::int64_t few_reports = 20'000;
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

ListQuery::ListQuery(SQLite::Database& database, const ListFilter& filter)
    : m_database(database), m_limit(filter.limit), m_words(words_of(filter.q)) {
    find_facets(filter);
    if (!filter.q.empty() && m_words.empty()) m_matches_nothing = true;
    m_by_words = !m_words.empty() && m_rarest > few_reports;
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

ListSql ListQuery::matching(Range places) const {
    ListSql sql;
    const bool by_facet = !m_by_words && !m_facets.empty();
    std::string place = "d.place";
    if (m_by_words) {
        place = "d.rowid";
        sql.text = "SELECT d.rowid FROM search_words d WHERE search_words MATCH ?";
        sql.values.emplace_back(fts_query(m_words));
    } else if (by_facet) {
        sql.text = "SELECT d.place FROM report_facets d WHERE d.facet = ?";
        sql.values.emplace_back(m_facets.front());
    } else {
        sql.text = "SELECT d.place FROM search_lines d WHERE 1";
    }
    sql.text += " AND " + place + " >= ? AND " + place + " < ?";
    sql.values.emplace_back(places.from);
    sql.values.emplace_back(m_matches_nothing ? places.from : places.before);
    for (std::size_t i = by_facet ? 1 : 0; i < m_facets.size(); ++i) {
        sql.text += " AND EXISTS (SELECT 1 FROM report_facets f WHERE f.facet = ? AND f.place = " + place + ")";
        sql.values.emplace_back(m_facets[i]);
    }
    for (const std::string& word : m_words) {
        if (m_by_words && word.size() <= longest_indexed_bytes) continue;
        sql.text += " AND (SELECT instr(l.words, ?) FROM search_lines l WHERE l.place = " + place + ") > 0";
        sql.values.emplace_back(" " + word);
    }
    return sql;
}

ListSql ListQuery::newest(Range places, std::int64_t limit) const {
    ListSql sql = matching(places);
    sql.text += m_by_words ? " ORDER BY d.rowid DESC LIMIT ?" : " ORDER BY d.place DESC LIMIT ?";
    sql.values.emplace_back(limit);
    return sql;
}

ListSql ListQuery::page() const {
    return newest({m_times.from, std::min(m_times.before, m_before_place)}, std::int64_t{m_limit} + 1);
}

ListSql ListQuery::first_places() const {
    return newest(m_times, max_exact_count + 1);
}

bool ListQuery::counts_by_reading() const {
    const bool is_at_any_time = m_times.from == 0 && m_times.before == INT64_MAX;
    return m_matches_nothing || !m_words.empty() || !is_at_any_time || m_facets.size() > 1;
}

ListSql ListQuery::counting() const {
    ListSql sql = matching(m_times);
    sql.text = "SELECT count(*) FROM (" + sql.text + " LIMIT ?)";
    sql.values.emplace_back(max_exact_count + 1);
    return sql;
}

std::pair<std::int64_t, bool> ListQuery::count() const {
    if (!counts_by_reading()) {
        if (m_facets.size() == 1) return {m_rarest, true};
        return {m_database.execAndGet("SELECT sum(reports) FROM facets WHERE id <= 5").getInt64(), true};
    }
    SQLite::Statement row(m_database, counting().text);
    counting().bind(row);
    const std::int64_t found = row.executeStep() ? row.getColumn(0).getInt64() : 0;
    return {std::min(found, max_exact_count), found <= max_exact_count};
}

}  // namespace sheer
