#include "server/archive/sqlite_trends.h"

#include <algorithm>
#include <map>

#include "server/archive/list_query.h"
#include "server/jobs/limits.h"
#include "server/storage/packed_text.h"

namespace sheer {

namespace {

/// Nothing if there are none or they are damaged.
std::optional<ReportNumbers> numbers_in(SQLite::Statement& row, std::map<std::int64_t, std::string>& names) {
    if (row.getColumn(2).isNull()) return std::nullopt;
    std::string& text = names[row.getColumn(2).getInt64()];
    if (text.empty()) text = row.getColumn(3).getString();
    const SQLite::Column packed = row.getColumn(4);
    try {
        return ReportNumbers{
            text, unpack_text({static_cast<const char*>(packed.getBlob()), static_cast<std::size_t>(packed.getBytes())},
                              max_report_bytes)};
    } catch (const DamagedData&) {
        return std::nullopt;
    }
}

}  // namespace

void add_numbers(SQLite::Database& database, const std::string& report_id, const ReportNumbers& numbers) {
    SQLite::Statement name(database, "INSERT INTO number_names (names) VALUES (?) ON CONFLICT DO NOTHING");
    name.bind(1, numbers.names);
    name.exec();
    SQLite::Statement insert(
        database,
        "INSERT INTO report_numbers SELECT ?1, id, ?3, sheer_seal(?1, names, ?3) FROM number_names "
        "WHERE names = ?2 ON CONFLICT DO NOTHING");
    const std::string packed = pack_numbers(numbers.numbers);
    SQLite::bind(insert, report_id, numbers.names);
    insert.bind(3, packed.data(), static_cast<int>(packed.size()));
    insert.exec();
}

std::vector<TrendReport> SqliteTrends::reports(const ListFilter& filter) {
    return m_archive.read([&](SQLite::Database& database) {
        SQLite::Transaction one_state(database, SQLite::TransactionBehavior::DEFERRED);
        std::vector<std::int64_t> places = ListQuery(database, filter).page();
        if (places.size() > static_cast<std::size_t>(filter.limit))
            places.resize(static_cast<std::size_t>(filter.limit));
        SQLite::Statement row(database,
                              "SELECT r.id, r.created_ms, n.names, names.names, n.numbers FROM search_lines l JOIN "
                              "reports r ON r.id = l.report_id LEFT JOIN report_numbers n ON n.report_id = r.id "
                              "LEFT JOIN number_names names ON names.id = n.names WHERE l.place = ?");
        std::vector<TrendReport> reports;
        std::map<std::int64_t, std::string> names;
        for (const std::int64_t place : places) {
            row.bind(1, place);
            if (row.executeStep())
                reports.push_back({row.getColumn(0).getString(), row.getColumn(1).getInt64(), numbers_in(row, names)});
            row.reset();
        }
        std::ranges::reverse(reports);
        return reports;
    });
}

void SqliteTrends::keep(const std::string& report_id, const ReportNumbers& numbers) {
    m_archive.write([&](SQLite::Database& database) { add_numbers(database, report_id, numbers); });
}

}  // namespace sheer
