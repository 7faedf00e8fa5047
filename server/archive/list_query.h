#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/archive/facet_bits.h"
#include "server/jobs/report_archive.h"

namespace sheer {

/// A statement with its values.
struct ListSql {
    std::string text;
    std::vector<std::variant<std::int64_t, std::string>> values;

    void bind(SQLite::Statement& statement) const;
};

/// How the reports of a filter are found. Those of one facet, of words, or of neither are a range of an index, newest
/// first. Those of several facets are found by the facets' bits (facet_bits.h). With words as well, these are compared
/// one by one if they are few, and otherwise with what the index of words has, both newest first. No statement sorts.
class ListQuery {
  public:
    /// The words of `few` reports are compared one by one in less time than FTS5 needs for two frequent words.
    ListQuery(SQLite::Database& database, const ListFilter& filter, std::size_t few = 2'000);

    /// The places of the page's reports, and one more if there is one.
    std::vector<std::int64_t> page() const;
    /// Whether the reports have to be found in order to be counted.
    bool counts_by_reading() const;
    /// The places of max_exact_count reports, and one more if there is one, whatever `before_id`.
    std::vector<std::int64_t> first_places() const;
    /// How many match, if !counts_by_reading().
    std::int64_t known_count() const;
    /// The statement that finds places: all that match, or, if there are facets and something else, those of the words.
    ListSql statement(PlaceRange range) const;

  private:
    std::vector<std::int64_t> newest(PlaceRange range, std::size_t limit) const;
    std::vector<std::int64_t> newest_with_words(PlaceRange range, std::size_t limit) const;
    bool has_words(SQLite::Statement& line, std::int64_t place) const;
    void find_facets(const ListFilter& filter);

    SQLite::Database& m_database;
    const int m_limit;
    const std::size_t m_few;
    bool m_matches_nothing = false;
    std::vector<std::int64_t> m_facets;  ///< the rarest first
    std::int64_t m_rarest = 0;           ///< how many reports have m_facets[0]
    std::vector<std::string> m_words;
    PlaceRange m_times;
    std::int64_t m_before_place = INT64_MAX;
};

}  // namespace sheer
