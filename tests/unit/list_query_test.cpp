// How lists are searched: by SQLite's plans, since times depend on the machine.
#include "server/archive/list_query.h"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <functional>

#include "server/archive/sqlite_functions.h"
#include "server/archive/sqlite_index.h"
#include "server/archive/sqlite_open.h"
#include "store_fixture.h"

namespace sheer::test::list_query_test {
namespace {

using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ListQueryTest : public WithSqlite {
  protected:
    std::vector<std::string> plan(const ListSql& sql) {
        SQLite::Database database = open_reader(m_data);
        SQLite::Statement rows(database, "EXPLAIN QUERY PLAN " + sql.text);
        sql.bind(rows);
        std::vector<std::string> steps;
        while (rows.executeStep()) steps.push_back(rows.getColumn(3).getString());
        return steps;
    }

    std::vector<std::string> plans(const ListFilter& filter) {
        SQLite::Database database = open_reader(m_data);
        return plan(ListQuery(database, filter).statement({}));
    }
};

TEST_F(ListQueryTest, NothingIsSortedAndNoTableIsReadFromEndToEnd) {
    const auto report = [&](const std::string& title) {
        submit(title, {{"tags", {{"branch", "main"}}}});
        const Lease job = lease();
        FinishedReport made = finished(job, title);
        made.report["device"] = {{"renderer", "llvmpipe"}};
        ASSERT_TRUE(m_queue.commit(job, made));
    };
    for (int i = 0; i < 3; ++i) report("title " + std::to_string(i));
    const std::string spec = m_reports.list({}).reports.at(0).spec_sha256;
    const std::string id = m_reports.list({}).reports.at(0).id;
    const std::vector<ListFilter> filters = {{},
                                             {.before_id = id},
                                             {.q = "title"},
                                             {.q = "title 1"},
                                             {.q = "longer than eight letters: extraordinary"},
                                             {.tags = {"branch"}},
                                             {.tags = {"branch:main", "branch"}},
                                             {.methods = {"b2f"}},
                                             {.scene = "quads"},
                                             {.device = "llvmpipe"},
                                             {.verdict = "passed"},
                                             {.spec_sha256 = spec},
                                             {.status = Status::done},
                                             {.since_ms = 5, .until_ms = m_now_ms},
                                             {.q = "title", .methods = {"b2f"}},
                                             {.q = "title",
                                              .tags = {"branch"},
                                              .methods = {"b2f"},
                                              .scene = "quads",
                                              .device = "llvmpipe",
                                              .verdict = "passed",
                                              .spec_sha256 = spec,
                                              .status = Status::done,
                                              .since_ms = 5,
                                              .until_ms = m_now_ms,
                                              .before_id = id}};
    for (const ListFilter& filter : filters) {
        const auto steps = plans(filter);
        EXPECT_THAT(steps, Each(Not(HasSubstr("TEMP B-TREE"))));
        // FTS5 reads a range of its own index.
        EXPECT_THAT(steps, Each(AnyOf(StartsWith("SEARCH"), StartsWith("SCAN search_words VIRTUAL TABLE INDEX"))));
    }
}

TEST_F(ListQueryTest, AFacetIsFollowedNewestFirst) {
    for (int i = 0; i < 4; ++i) submit("common");
    const std::string rare = submit("rare", {{"scene", {{"type", "layers"}}}});
    SQLite::Database database = open_reader(m_data);
    const ListQuery query(database, {.scene = "layers"});
    EXPECT_FALSE(query.counts_by_reading());
    EXPECT_EQ(query.known_count(), 1);
    EXPECT_EQ(query.page(), std::vector{place_of(rare)});
    EXPECT_EQ(m_reports.list({.methods = {"b2f"}, .scene = "layers"}).count, 1);
}

/// Two thousand reports of one method and as many of another one, every tenth of these of both, as the index has them.
class ManyReportsTest : public ListQueryTest {
  protected:
    static constexpr int count = 4'000;

    ManyReportsTest() : m_database(open_archive(m_data)) {
        SQLite::Transaction all(m_database);
        SQLite::Statement row(m_database,
                              "INSERT INTO reports (id, status, created_ms, title, scene, spec_sha256, spec) "
                              "VALUES (?, 'queued', 1, '', 'quads', 'hash', '{}')");
        for (int i = 0; i < count; ++i) {
            m_now_ms += 1;
            IndexedReport report{.id = m_ids.next(), .spec_sha256 = "hash"};
            report.facets.title = i % 2 ? "odd" : "even";
            report.facets.scene = "quads";
            report.facets.methods = {i % 2 ? "f2b" : "b2f"};
            if (i % 20 == 0) report.facets.methods.push_back("f2b");
            if (i == 30) report.facets.tags["rare"] = "once";
            row.bind(1, report.id);
            row.exec();
            row.reset();
            add_to_index(m_database, report);
            m_places.push_back(place_of(report.id));
        }
        all.commit();
    }

    /// Steps of SQLite's virtual machine, in hundreds.
    template <typename Work>
    int steps(const Work& work) {
        int hundreds = 0;
        const auto count_up = [](void* counter) {
            ++*static_cast<int*>(counter);
            return 0;
        };
        sqlite3_progress_handler(m_database.getHandle(), 100, count_up, &hundreds);
        work();
        sqlite3_progress_handler(m_database.getHandle(), 0, nullptr, nullptr);
        return hundreds;
    }

    SQLite::Database m_database;
    std::vector<std::int64_t> m_places;  ///< of each report
};

TEST_F(ManyReportsTest, FacetsThatAreRarelyTogetherAreNotLookedUpOneByOne) {
    std::vector<std::int64_t> found;
    const ListFilter both{.methods = {"b2f", "f2b"}};
    EXPECT_LE(steps([&] { found = ListQuery(m_database, both).first_places(); }), 5);
    std::vector<std::int64_t> expected;
    for (int i = count - 20; i >= 0; i -= 20) expected.push_back(m_places[static_cast<std::size_t>(i)]);
    EXPECT_EQ(found, expected);
    const ListFilter never{.tags = {"rare"}, .methods = {"f2b"}};
    EXPECT_LE(steps([&] { found = ListQuery(m_database, never).first_places(); }), 5);
    EXPECT_EQ(found, std::vector<std::int64_t>{});
    // A page of the newest reads one block.
    EXPECT_LE(steps([&] { found = ListQuery(m_database, {.methods = {"f2b"}, .scene = "quads"}).page(); }), 5);
    EXPECT_EQ(found.size(), 21u);
    EXPECT_EQ(found.front(), m_places[count - 1]);
}

TEST_F(ManyReportsTest, WordsAndTimesAndPagesOfFacetsAreThoseOfTheReports) {
    ListFilter filter{.q = "ev", .methods = {"f2b"}, .scene = "quads"};
    const auto one_by_one = ListQuery(m_database, filter, count).first_places();
    EXPECT_EQ(one_by_one.size(), std::size_t{count / 20});
    EXPECT_EQ(one_by_one.front(), m_places[count - 20]);
    EXPECT_EQ(ListQuery(m_database, filter, 0).first_places(), one_by_one) << "by the index of words";
    filter.q = "ev od";
    EXPECT_EQ(ListQuery(m_database, filter).first_places().size(), 0u);
    EXPECT_EQ(ListQuery(m_database, filter, 0).first_places().size(), 0u);
    filter = {.q = "eve", .tags = {"rare:once"}, .methods = {"b2f"}};
    EXPECT_EQ(ListQuery(m_database, filter).first_places(), std::vector{m_places[30]});
    filter.q = "odd";
    EXPECT_EQ(ListQuery(m_database, filter).first_places().size(), 0u);
    // The ids are of one millisecond each.
    filter = {.methods = {"b2f"}, .scene = "quads", .since_ms = m_now_ms - 9, .until_ms = m_now_ms - 5};
    const std::vector<std::int64_t> expected = {m_places[count - 6], m_places[count - 8], m_places[count - 10]};
    EXPECT_EQ(ListQuery(m_database, filter).first_places(), expected);
}

TEST_F(ManyReportsTest, BlocksFollowWhatIsDeletedAndWhatComesLate) {
    EXPECT_TRUE(facet_bits_are_right(m_database));
    EXPECT_EQ(m_database.execAndGet("SELECT count(*) FROM search_blocks").getInt(), 4);
    m_database.exec("DELETE FROM search_lines WHERE slot >= 1024 AND slot < 2048 OR slot % 3 = 0");
    EXPECT_TRUE(facet_bits_are_right(m_database));
    EXPECT_EQ(m_database.execAndGet("SELECT count(*) FROM search_blocks").getInt(), 3);
    EXPECT_EQ(m_database.execAndGet("SELECT count(*) FROM facet_bits WHERE block = 1").getInt(), 0);
    // Imported: older than the others, but in the newest block.
    const std::string old = "01800000-0000-7000-8000-000000000001";
    m_database.exec(
        "INSERT INTO reports (id, status, created_ms, title, scene, spec_sha256, spec) "
        "VALUES ('" +
        old + "', 'queued', 1, '', 'quads', 'hash', '{}')");
    IndexedReport late{.id = old, .spec_sha256 = "hash"};
    late.facets = {.title = "", .scene = "quads", .methods = {"f2b"}};
    add_to_index(m_database, late);
    EXPECT_TRUE(facet_bits_are_right(m_database));
    const auto found = ListQuery(m_database, {.methods = {"f2b"}, .scene = "quads"}).first_places();
    EXPECT_EQ(found.back(), place_of(old));
    EXPECT_TRUE(std::ranges::is_sorted(found, std::greater()));
    rebuild_facet_bits(m_database);
    EXPECT_TRUE(facet_bits_are_right(m_database));
    for (const char* change :
         {"UPDATE facet_bits SET bits = sheer_with_bit(bits, 7, 0) WHERE block = 0 AND facet = (SELECT max(facet) FROM "
          "facet_bits WHERE block = 0)",
          "UPDATE search_blocks SET newest = newest + 1 WHERE block = 0", "DELETE FROM facet_bits WHERE block = 2",
          "UPDATE search_lines SET slot = 9999 WHERE slot = 1"}) {
        SQLite::Transaction undone(m_database);
        ASSERT_EQ(m_database.exec(change) > 0, true) << change;
        EXPECT_FALSE(facet_bits_are_right(m_database)) << change;
    }
}

}  // namespace
}  // namespace sheer::test::list_query_test
