#include "store_fixture.h"

namespace sheer::test::leases_test {
namespace {

using LeasesTest = StoreTest;
using nlohmann::json;

TEST_F(LeasesTest, JobsAreLeasedOldestFirstAndOnce) {
    const std::string first = submit("first"), second = submit("second");
    EXPECT_EQ(lease("a").id, first);
    EXPECT_EQ(lease("b").id, second);
    EXPECT_FALSE(m_store.lease("c"));
    EXPECT_EQ(status(first), Status::running);
}

TEST_F(LeasesTest, AHeartbeatKeepsTheLeaseAndTheProgress) {
    const std::string id = submit();
    const Lease job = lease();
    for (int i = 0; i < 5; ++i) {
        m_now_ms += m_rules.lease_ms - 1;
        EXPECT_FALSE(m_store.lease("other"));
        EXPECT_EQ(m_store.heartbeat(job, 0.1 * i, "timing"), LeaseState::held);
    }
    EXPECT_DOUBLE_EQ(m_store.find(id)->progress, 0.4);
    EXPECT_EQ(m_store.find(id)->stage, "timing");
}

TEST_F(LeasesTest, OnlyWhatAReaderSeesMakesARevision) {
    const std::string id = submit();
    const Lease job = lease();
    m_store.heartbeat(job, 0.5, "timing");
    const std::int64_t revision = m_store.find(id)->revision;
    m_store.heartbeat(job, 0.5, "timing");
    EXPECT_EQ(m_store.find(id)->revision, revision);
    m_store.heartbeat(job, 0.5, "measuring");
    EXPECT_EQ(m_store.find(id)->revision, revision + 1);
}

TEST_F(LeasesTest, ALeaseThatRanOutGoesToAnotherWorkerOnce) {
    const std::string id = submit();
    const Lease lost = lease("dead");
    m_store.heartbeat(lost, 0.7, "timing");
    m_now_ms += m_rules.lease_ms + 1;
    const Lease second = lease("next");
    EXPECT_EQ(second.id, id);
    EXPECT_EQ(second.attempt, 2);
    EXPECT_EQ(m_store.find(id)->progress, 0);
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_FALSE(m_store.lease("third"));
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_store.find(id)->error->title, "Rendering failed");
    EXPECT_EQ(m_store.find(id)->error->detail, "The worker died while it rendered this report.");
    EXPECT_EQ(m_store.find(id)->finished_ms, m_now_ms);
}

TEST_F(LeasesTest, AfterAJobThatIsGivenUpTheNextRuns) {
    m_rules.max_attempts = 1;
    SqliteStore store(m_folder.path() / "data", m_rules, m_clock);
    submit("kills");
    const std::string next = submit("harmless");
    store.lease("dead");
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_EQ(store.lease("alive")->id, next);
}

TEST_F(LeasesTest, AWorkerThatLostItsLeaseCannotTouchTheJob) {
    const std::string id = submit();
    const Lease lost = lease("worker");
    m_now_ms += m_rules.lease_ms + 1;
    const Lease held = lease("worker");  // the same name does not help
    EXPECT_EQ(m_store.heartbeat(lost, 0.9, "late"), LeaseState::lost);
    EXPECT_EQ(m_store.state(lost), LeaseState::lost);
    EXPECT_FALSE(m_store.commit(lost, finished(lost, "late")));
    m_store.fail(lost, {"late", "late"}, false);
    m_store.release(lost);
    m_store.cancel(lost);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_store.state(held), LeaseState::held);
    EXPECT_TRUE(m_store.commit(held, finished(held, "in time")));
    EXPECT_FALSE(m_store.commit(held, finished(held, "twice")));
}

TEST_F(LeasesTest, TheLeasesOfADeadWorkerEndAtOnce) {
    const std::string first = submit("first"), second = submit("second");
    lease("dead");
    lease("alive");
    m_store.end_leases_of("dead");
    EXPECT_EQ(status(first), Status::queued);
    EXPECT_EQ(status(second), Status::running);
}

TEST_F(LeasesTest, AnAttemptThatMaySucceedNextTimeIsRepeated) {
    const std::string id = submit();
    m_store.fail(lease(), {"died", "signal 11"}, true);
    EXPECT_EQ(status(id), Status::queued);
    m_store.fail(lease(), {"died", "signal 11"}, true);
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_store.find(id)->error->detail, "signal 11");
}

TEST_F(LeasesTest, AnAttemptThatCannotSucceedIsNotRepeated) {
    const std::string id = submit();
    m_store.fail(lease(), {"unsupported", ""}, false);
    EXPECT_EQ(status(id), Status::failed);
}

TEST_F(LeasesTest, AJobThatIsGivenBackWasNotTried) {
    const std::string id = submit();
    for (int i = 0; i < 5; ++i) {
        const Lease job = lease();
        EXPECT_EQ(job.attempt, 1);
        m_store.release(job);
        EXPECT_EQ(status(id), Status::queued);
    }
}

TEST_F(LeasesTest, AQueuedJobIsCancelledAtOnce) {
    const std::string id = submit();
    EXPECT_EQ(m_store.remove(id), RemoveResult::cancelled);
    EXPECT_EQ(status(id), Status::cancelled);
    EXPECT_FALSE(m_store.lease("worker"));
    EXPECT_EQ(m_store.remove(id), RemoveResult::deleted);
}

TEST_F(LeasesTest, ARunningJobIsCancelledByItsWorker) {
    const std::string id = submit();
    const Lease job = lease();
    EXPECT_EQ(m_store.remove(id), RemoveResult::cancelling);
    EXPECT_EQ(m_store.remove(id), RemoveResult::cancelling);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_store.state(job), LeaseState::cancel_requested);
    EXPECT_EQ(m_store.heartbeat(job, 0.5, ""), LeaseState::cancel_requested);
    m_store.cancel(job);
    EXPECT_EQ(status(id), Status::cancelled);
}

TEST_F(LeasesTest, ACancelledJobStaysCancelledHoweverItsAttemptEnds) {
    const auto cancelled_running = [this] {
        submit();
        const Lease job = lease();
        m_store.remove(job.id);
        return job;
    };
    const Lease done = cancelled_running();
    EXPECT_FALSE(m_store.commit(done, finished(done, "picture")));
    EXPECT_EQ(status(done.id), Status::cancelled);
    const Lease failed = cancelled_running();
    m_store.fail(failed, {"died", ""}, true);
    EXPECT_EQ(status(failed.id), Status::cancelled);
    const Lease released = cancelled_running();
    m_store.release(released);
    EXPECT_EQ(status(released.id), Status::cancelled);
    const Lease lost = cancelled_running();
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_FALSE(m_store.lease("next"));
    EXPECT_EQ(status(lost.id), Status::cancelled);
}

TEST_F(LeasesTest, ACommitIsWholeOrNotAtAll) {
    const std::string id = submit();
    const Lease job = lease();
    FinishedReport report = finished(job, "there");
    report.blobs.push_back({sha256_hex("missing"), "image/png", m_folder.path() / "missing"});
    EXPECT_THROW(m_store.commit(job, report), StoreError);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_FALSE(m_store.find_blob(sha256_hex("there")));
    report.blobs.pop_back();
    EXPECT_TRUE(m_store.commit(job, report));
    EXPECT_TRUE(m_store.find_blob(sha256_hex("there")));
}

TEST_F(LeasesTest, AFinishedJobCountsAsRendering) {
    EXPECT_FALSE(m_store.last_rendered_ms());
    make_done("done", "picture");
    EXPECT_EQ(m_store.last_rendered_ms(), m_now_ms);
    m_now_ms += 5;
    m_store.note_rendered();
    EXPECT_EQ(m_store.last_rendered_ms(), m_now_ms);
}

TEST(LeaseRulesTest, WhatBecomesOfALostAttempt) {
    const LeaseRules rules{.max_attempts = 2};
    EXPECT_EQ(after_lost_attempt(1, false, rules), Status::queued);
    EXPECT_EQ(after_lost_attempt(2, false, rules), Status::failed);
    EXPECT_EQ(after_lost_attempt(1, true, rules), Status::cancelled);
}

}  // namespace
}  // namespace sheer::test::leases_test
