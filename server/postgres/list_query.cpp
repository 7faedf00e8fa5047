#include "server/postgres/list_query.h"

#include <fmt/format.h>

#include "server/jobs/search.h"

namespace sheer::postgres {

namespace {

/// Each word as the beginning of one, as to_tsquery() reads it. Words have neither quotes nor backslashes.
std::string words_query(const std::vector<std::string>& words) {
    std::string query;
    for (const std::string& word : words) query += fmt::format("{}'{}':*", query.empty() ? "" : " & ", word);
    return query;
}

}  // namespace

ListQuery::ListQuery(const ListFilter& filter) : m_before_id(filter.before_id), m_limit(filter.limit) {
    ListFilter facets = filter;
    facets.status.reset();
    const std::vector<std::string> wanted = wanted_facet_texts(facets);
    if (!wanted.empty()) require("r.facets @> {}", wanted);
    m_fields += static_cast<int>(wanted.size()) - (wanted.empty() ? 0 : 1);
    if (filter.status) {
        const std::string status(status_text(*filter.status));
        if (is_final(*filter.status)) {
            require("r.status = {}", status);
        } else {
            // Few reports have jobs.
            m_join = "JOIN";
            require("j.status = {}", status);
        }
    }
    const std::vector<std::string> words = words_of(filter.q);
    if (!words.empty()) require("r.words @@ {}::tsquery", words_query(words));
    if (!filter.q.empty() && words.empty()) require("{}", false);
    if (filter.since_ms) require("r.created_ms >= {}", *filter.since_ms);
    if (filter.until_ms) require("r.created_ms <= {}", *filter.until_ms);
}

void ListQuery::require(const std::string& condition, Value value) {
    m_values.push_back(std::move(value));
    m_conditions += " AND " + fmt::format(fmt::runtime(condition), fmt::format("${}", m_values.size()));
    ++m_fields;
}

std::string ListQuery::from() const {
    return fmt::format("reports r {} jobs j ON j.report_id = r.id WHERE {}", m_join, m_conditions);
}

Query ListQuery::page(const std::string& columns) const {
    Query query{fmt::format("SELECT {} FROM {}", columns, from()), m_values};
    if (!m_before_id.empty()) {
        query.values.emplace_back(m_before_id);
        query.text += fmt::format(" AND r.id < ${}", query.values.size());
    }
    query.values.emplace_back(m_limit + 1);
    query.text += fmt::format(" ORDER BY r.id DESC LIMIT ${}", query.values.size());
    return query;
}

Query ListQuery::count() const {
    // Only what a condition needs is joined: LEFT JOIN of a unique key is dropped by the planner.
    if (counts_all()) return {fmt::format("SELECT count(*) FROM {}", from()), m_values};
    return {fmt::format("SELECT count(*) FROM (SELECT FROM {} LIMIT {}) found", from(), max_exact_count + 1), m_values};
}

}  // namespace sheer::postgres
