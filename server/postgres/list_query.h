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
/// have one. The indexes of facets and words find rare ones, and the order of ids finds frequent ones; PostgreSQL's
/// planner chooses by what it knows of their frequencies.
class ListQuery {
  public:
    explicit ListQuery(const ListFilter& filter);

    /// `columns` of the page's reports, and of one more if there is one, newest first.
    Query page(const std::string& columns) const;
    /// How many match whatever `before_id`, up to max_exact_count + 1 unless the filter has at most one field.
    Query count() const;
    /// Whether count() counts all of them.
    bool counts_all() const { return m_fields <= 1; }

  private:
    /// Adds "AND `condition`" with {} for the value.
    void require(const std::string& condition, Value value);

    std::string from() const;

    const char* m_join = "LEFT JOIN";
    std::string m_conditions = "true";
    std::vector<Value> m_values;
    std::string m_before_id;
    std::int64_t m_limit;
    int m_fields = 0;
};

}  // namespace sheer::postgres
