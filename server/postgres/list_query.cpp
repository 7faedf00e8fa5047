#include "server/postgres/list_query.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/jobs/search.h"

namespace sheer::postgres {

namespace {

/// So many are read in a few hundredths of a second.
constexpr int newest_reports = 10'000;
/// By how much the clock of the service that made an id may differ from the database's.
constexpr std::int64_t clock_difference_ms = 86'400'000;

/// The beginning of the ids (UUID version 7) that are made at this time.
std::string id_at(std::int64_t time_ms) {
    const std::string digits =
        fmt::format("{:012x}", std::clamp<std::int64_t>(time_ms, 0, (std::int64_t{1} << 48) - 1));
    return digits.substr(0, 8) + "-" + digits.substr(8);
}

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
    // The index of ids finds them.
    const int fields = m_fields;
    if (filter.since_ms) require("r.id >= {}", id_at(*filter.since_ms - clock_difference_ms));
    if (filter.until_ms) require("r.id <= {}", id_at(*filter.until_ms + clock_difference_ms) + "~");
    m_fields = fields;
}

void ListQuery::require(const std::string& condition, Value value) {
    m_values.push_back(std::move(value));
    m_conditions += " AND " + fmt::format(fmt::runtime(condition), fmt::format("${}", m_values.size()));
    ++m_fields;
}

std::string ListQuery::from(const std::string& reports) const {
    return fmt::format("{} r {} jobs j ON j.report_id = r.id WHERE {}", reports, m_join, m_conditions);
}

std::string ListQuery::before(const std::string& id, Query& query) const {
    if (m_before_id.empty()) return "";
    query.values.emplace_back(m_before_id);
    return fmt::format(" AND {} < ${}", id, query.values.size());
}

Query ListQuery::among_newest(const std::string& columns) const {
    Query query{"", m_values};
    const std::string older = before("id", query);
    const std::string newest =
        fmt::format("(SELECT * FROM reports WHERE true{} ORDER BY id DESC LIMIT {})", older, newest_reports);
    query.text = fmt::format("SELECT {} FROM {} ORDER BY r.id DESC LIMIT {}", columns, from(newest), m_limit + 1);
    return query;
}

Query ListQuery::by_indexes(const std::string& columns) const {
    Query query{"", m_values};
    const std::string older = before("id", query);
    // Without MATERIALIZED the planner would see the order and the limit.
    query.text = fmt::format(
        "WITH found AS MATERIALIZED (SELECT r.id FROM {}), newest AS (SELECT id FROM found WHERE true{} ORDER BY id "
        "DESC "
        "LIMIT {}) SELECT {} FROM newest JOIN reports r USING (id) LEFT JOIN jobs j ON j.report_id = r.id ORDER BY "
        "r.id "
        "DESC",
        from("reports"), older, m_limit + 1, columns);
    return query;
}

Rows ListQuery::page(Connection& connection, const std::string& columns) const {
    const Query newest = among_newest(columns), all = by_indexes(columns);
    Rows rows = connection.run(newest.text, newest.values);
    if (m_fields == 0 || rows.count() > m_limit) return rows;
    return connection.run(all.text, all.values);
}

Query ListQuery::count() const {
    // Only what a condition needs is joined: LEFT JOIN of a unique key is dropped by the planner.
    if (counts_all()) return {fmt::format("SELECT count(*) FROM {}", from("reports")), m_values};
    return {fmt::format("SELECT count(*) FROM (SELECT FROM {} LIMIT {}) found", from("reports"), max_exact_count + 1),
            m_values};
}

}  // namespace sheer::postgres
