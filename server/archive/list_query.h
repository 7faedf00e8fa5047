#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/jobs/report_archive.h"

namespace sheer {

/// A statement with its values.
struct ListSql {
    std::string text;
    std::vector<std::variant<std::int64_t, std::string>> values;

    void bind(SQLite::Statement& statement) const;
};

/// How the reports of a filter are found: along the places, newest first, of the rarest of the wanted facets, or of the
/// wanted words if they are likely to be rarer, or of all reports; each is looked up in the other facets. No statement
/// reads more than that one range, and none sorts.
class ListQuery {
  public:
    ListQuery(SQLite::Database& database, const ListFilter& filter);

    /// The places of the page's reports, and one more if there is one.
    ListSql page() const;
    /// Whether count() reads the reports, one by one.
    bool counts_by_reading() const;
    /// The places of max_exact_count reports, and one more if there is one, whatever `before_id`.
    ListSql first_places() const;
    /// How many match, up to max_exact_count, and whether these are all.
    std::pair<std::int64_t, bool> count() const;
    /// The statement with which count() counts.
    ListSql counting() const;

  private:
    struct Range {
        std::int64_t from = 0, before = INT64_MAX;
    };

    ListSql matching(Range places) const;
    ListSql newest(Range places, std::int64_t limit) const;
    void find_facets(const ListFilter& filter);

    SQLite::Database& m_database;
    const int m_limit;
    bool m_matches_nothing = false;
    bool m_by_words = false;             ///< along the words, not along a facet
    std::vector<std::int64_t> m_facets;  ///< the rarest first
    std::int64_t m_rarest = INT64_MAX;   ///< how many reports have m_facets[0]
    std::vector<std::string> m_words;
    Range m_times;
    std::int64_t m_before_place = INT64_MAX;
};

}  // namespace sheer
