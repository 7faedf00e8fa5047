// Accepted reports, in every store.
#include "server/jobs/baselines.h"

#include <gmock/gmock.h>

#include "store_fixture.h"

namespace sheer::test::baselines_test {
namespace {

using Acceptance = Baselines::Acceptance;
using Removal = ReportArchive::Removal;
using testing::ElementsAre;

class BaselinesTest : public StoreTest {
  protected:
    Acceptance accept(const std::string& name, const std::string& id, const std::string& reason = "") {
        m_now_ms += 1000;
        return m_baselines.accept({name, id, 0, "me", reason});
    }

    std::vector<std::string> ids(const std::string& name) {
        std::vector<std::string> all;
        for (const AcceptedReport& one : m_baselines.list(name)) all.push_back(one.name + " " + one.report_id);
        return all;
    }

    Baselines& m_baselines = m_store.baselines();
};

TEST_P(BaselinesTest, HoldsSeveralReportsThoseAcceptedLastFirst) {
    const std::string a = make_done("a", "1"), b = make_done("b", "2");
    EXPECT_EQ(accept("main", b), Acceptance::added);
    EXPECT_EQ(accept("main", a), Acceptance::added);
    EXPECT_EQ(accept("release", b), Acceptance::added);
    EXPECT_THAT(ids("main"), ElementsAre("main " + a, "main " + b));
    EXPECT_THAT(ids(""), ElementsAre("main " + a, "main " + b, "release " + b));
    EXPECT_EQ(accept("main", b, "again"), Acceptance::renewed);
    EXPECT_THAT(ids("main"), ElementsAre("main " + b, "main " + a));
    const AcceptedReport newest = m_baselines.list("main").front();
    EXPECT_EQ(newest.reason, "again");
    EXPECT_EQ(newest.by, "me");
    EXPECT_EQ(newest.accepted_ms, m_now_ms);
    EXPECT_TRUE(m_baselines.list("other").empty());
}

TEST_P(BaselinesTest, TakesOnlyReportsThatAreDone) {
    const std::string queued = submit("queued");
    EXPECT_EQ(accept("main", queued), Acceptance::not_done);
    EXPECT_EQ(accept("main", "nothing"), Acceptance::not_found);
    EXPECT_TRUE(m_baselines.list("").empty());
}

TEST_P(BaselinesTest, AnAcceptedReportIsNotDeletedUntilItIsForgotten) {
    const std::string a = make_done("a", "1"), b = make_done("b", "2");
    accept("main", a);
    accept("main", b);
    EXPECT_EQ(m_reports.remove(a), Removal::accepted);
    EXPECT_TRUE(m_reports.find(a));
    EXPECT_EQ(m_baselines.forget("main", a), 1u);
    EXPECT_EQ(m_baselines.forget("main", a), 0u);
    EXPECT_EQ(m_reports.remove(a), Removal::deleted);
    accept("main", make_done("c", "3"));
    EXPECT_EQ(m_baselines.forget("release", ""), 0u);
    EXPECT_EQ(m_baselines.forget("main", ""), 2u);
    EXPECT_TRUE(m_baselines.list("main").empty());
    EXPECT_TRUE(m_reports.find(b)) << "forgetting a baseline keeps its reports";
}

INSTANTIATE_TEST_SUITE_P(Stores, BaselinesTest, every_store, store_name);

}  // namespace
}  // namespace sheer::test::baselines_test
