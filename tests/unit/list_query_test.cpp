// How lists are searched: by SQLite's plans, since times depend on the machine.
#include "server/archive/list_query.h"

#include <gmock/gmock.h>

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
        const ListQuery query(database, filter);
        std::vector<std::string> all = plan(query.page());
        for (std::string& step : plan(query.first_places())) all.push_back(std::move(step));
        for (std::string& step : plan(query.counting())) all.push_back(std::move(step));
        return all;
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
        EXPECT_THAT(steps,
                    Each(AnyOf(StartsWith("SEARCH"), StartsWith("SCAN d VIRTUAL TABLE INDEX"), StartsWith("CORRELATED"),
                               StartsWith("CO-ROUTINE"), StartsWith("SCAN (subquery"), StartsWith("SCAN CONSTANT"))));
    }
}

TEST_F(ListQueryTest, TheRarestFacetIsFollowed) {
    for (int i = 0; i < 4; ++i) submit("common");
    submit("rare", {{"scene", {{"type", "layers"}}}});
    SQLite::Database database = open_reader(m_data);
    const ListQuery query(database, {.methods = {"b2f"}, .scene = "layers"});
    SQLite::Statement rare(database, "SELECT id FROM facets WHERE reports = 1 AND facet LIKE 'scene%layers'");
    ASSERT_TRUE(rare.executeStep());
    EXPECT_EQ(std::get<std::int64_t>(query.page().values.at(0)), rare.getColumn(0).getInt64());
    EXPECT_EQ(query.count(), (std::pair<std::int64_t, bool>{1, true}));
}

}  // namespace
}  // namespace sheer::test::list_query_test
