#pragma once
#include <string>
#include <vector>

#include "server/jobs/report_archive.h"
#include "server/postgres/connection.h"

namespace sheer::postgres {

/// A statement with its values.
struct Query {
    std::string text;
    std::vector<Value> values;
};

/// Which reports a filter asks for, as the part of a statement after FROM: `reports r`, and `jobs j` for those that
/// have one.
///
/// PostgreSQL's planner does not know which words and facets go together, nor how many words begin with another one, so
/// it would often read all reports by their ids for a few rare ones. So a page is looked for in two steps: among the
/// newest reports, where frequent ones are found at once, and then by the indexes of facets and words.
class ListQuery {
  public:
    explicit ListQuery(const ListFilter& filter);

    /// `columns` of the page's reports, and of one more if there is one, newest first.
    Rows page(Connection& connection, const std::string& columns) const;
    /// How many match whatever `before_id`, up to max_exact_count + 1 unless the filter has at most one field.
    Query count() const;
    /// Whether count() counts all of them.
    bool counts_all() const { return m_fields <= 1; }

  private:
    /// Adds "AND `condition`" with {} for the value.
    void require(const std::string& condition, Value value);

    std::string from(const std::string& reports) const;
    Query among_newest(const std::string& columns) const;
    Query by_indexes(const std::string& columns) const;
    /// "AND `id` < ..." for pages after the first.
    std::string before(const std::string& id, Query& query) const;

    const char* m_join = "LEFT JOIN";
    std::string m_conditions = "true";
    std::vector<Value> m_values;
    std::string m_before_id;
    std::int64_t m_limit;
    int m_fields = 0;
};

}  // namespace sheer::postgres
