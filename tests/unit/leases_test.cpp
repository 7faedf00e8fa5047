// How every store handles jobs.
#include "store_fixture.h"

namespace sheer::test::leases_test {
namespace {

using LeasesTest = StoreTest;
using Removal = ReportArchive::Removal;

TEST_P(LeasesTest, JobsAreLeasedOldestFirstAndOnce) {
    const std::string first = submit("first"), second = submit("second");
    EXPECT_EQ(lease("a").id, first);
    EXPECT_EQ(lease("b").id, second);
    EXPECT_FALSE(m_queue.lease("c"));
    EXPECT_EQ(status(first), Status::running);
}

TEST_P(LeasesTest, ASpecWithADeviceWaitsForAWorkerWithThisLabel) {
    const std::string nvidia = submit("on a GPU", {{"device", "nvidia"}}), any = submit("anywhere");
    const std::string amd = submit("on another", {{"device", "amd"}});
    EXPECT_EQ(m_queue.lease("a", "intel")->id, any);
    EXPECT_FALSE(m_queue.lease("a", "intel"));
    EXPECT_FALSE(m_queue.lease("a"));
    EXPECT_FALSE(m_queue.lease("a", "nvid"));
    const auto leased = m_queue.lease("b", "nvidia");
    ASSERT_TRUE(leased);
    EXPECT_EQ(leased->id, nvidia);
    EXPECT_FALSE(m_queue.lease("b", "nvidia"));
    m_queue.release(*leased);
    EXPECT_FALSE(m_queue.lease("a", "intel")) << "it keeps its wish";
    EXPECT_EQ(m_queue.lease("b", "nvidia")->id, nvidia);
    EXPECT_EQ(m_queue.lease("c", "amd")->id, amd);
}

TEST_P(LeasesTest, WorkersAreSeenWhileTheyGiveASignOfLife) {
    Workers& workers = m_store.workers();
    workers.note({.name = "b", .label = "nvidia", .driver = ""});
    m_now_ms += 60'000;
    workers.note({.name = "a", .label = "nvidia", .driver = "llvmpipe"});
    workers.note({.name = "c", .label = "local", .driver = ""});
    const auto names = [&](std::int64_t age_ms) {
        std::string all;
        for (const SeenWorker& worker : workers.list(age_ms)) all += worker.name;
        return all;
    };
    EXPECT_EQ(names(60'000), "cab");
    EXPECT_EQ(names(59'999), "ca");
    m_now_ms += 60'000;
    submit("job", {{"device", "nvidia"}});
    const Lease job = *m_queue.lease("a", "nvidia");
    ASSERT_EQ(names(59'000), "a") << "a job's heartbeats are signs of life";
    const SeenWorker seen = workers.list(59'000).at(0);
    EXPECT_EQ(seen.label, "nvidia");
    EXPECT_EQ(seen.driver, "llvmpipe");
    EXPECT_EQ(seen.job, job.id);
    EXPECT_EQ(seen.seen_ms, m_now_ms);
    m_queue.cancel(job);
    EXPECT_EQ(names(59'000), "");
    EXPECT_EQ(workers.list(60'001).at(0).job, "");
}

TEST_P(LeasesTest, AHeartbeatKeepsTheLeaseAndTheProgress) {
    const std::string id = submit();
    const Lease job = lease();
    for (int i = 0; i < 5; ++i) {
        m_now_ms += m_rules.lease_ms - 1;
        EXPECT_FALSE(m_queue.lease("other"));
        EXPECT_EQ(m_queue.heartbeat(job, 0.1 * i, "timing"), LeaseState::held);
    }
    EXPECT_DOUBLE_EQ(m_reports.find(id)->progress, 0.4);
    EXPECT_EQ(m_reports.find(id)->stage, "timing");
}

TEST_P(LeasesTest, OnlyVisibleChangesMakeARevision) {
    const std::string id = submit();
    const Lease job = lease();
    m_queue.heartbeat(job, 0.5, "timing");
    const std::int64_t revision = m_reports.find(id)->revision;
    m_queue.heartbeat(job, 0.5, "timing");
    EXPECT_EQ(m_reports.find(id)->revision, revision);
    m_queue.heartbeat(job, 0.5, "measuring");
    EXPECT_EQ(m_reports.find(id)->revision, revision + 1);
}

TEST_P(LeasesTest, AnExpiredLeaseGoesToAnotherWorkerOnce) {
    const std::string id = submit();
    const Lease lost = lease("dead");
    m_queue.heartbeat(lost, 0.7, "timing");
    m_now_ms += m_rules.lease_ms + 1;
    const Lease second = lease("next");
    EXPECT_EQ(second.id, id);
    EXPECT_EQ(second.attempt, 2);
    EXPECT_EQ(m_reports.find(id)->progress, 0);
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_FALSE(m_queue.lease("third"));
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_reports.find(id)->error->title, "Rendering failed");
    EXPECT_EQ(m_reports.find(id)->error->detail, "The worker died while it rendered this report.");
    EXPECT_EQ(m_reports.find(id)->finished_ms, m_now_ms);
}

TEST_P(LeasesTest, AfterAJobThatIsGivenUpTheNextRuns) {
    m_rules.max_attempts = 1;
    const auto store = m_place->open(m_rules, m_clock);
    submit("kills");
    const std::string next = submit("harmless");
    store->queue().lease("dead");
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_EQ(store->queue().lease("alive")->id, next);
}

TEST_P(LeasesTest, AWorkerThatLostItsLeaseCannotTouchTheJob) {
    const std::string id = submit();
    const Lease lost = lease("worker");
    m_now_ms += m_rules.lease_ms + 1;
    const Lease held = lease("worker");  // the same name does not help
    EXPECT_EQ(m_queue.heartbeat(lost, 0.9, "late"), LeaseState::lost);
    EXPECT_EQ(m_queue.state(lost), LeaseState::lost);
    EXPECT_FALSE(m_queue.commit(lost, finished(lost, "late")));
    m_queue.fail(lost, {"late", "late"}, false);
    m_queue.release(lost);
    m_queue.cancel(lost);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_queue.state(held), LeaseState::held);
    EXPECT_TRUE(m_queue.commit(held, finished(held, "in time")));
    EXPECT_FALSE(m_queue.commit(held, finished(held, "twice")));
}

TEST_P(LeasesTest, TheLeasesOfADeadWorkerEndAtOnce) {
    const std::string first = submit("first"), second = submit("second");
    lease("dead");
    lease("alive");
    m_queue.end_leases_of("dead");
    EXPECT_EQ(status(first), Status::queued);
    EXPECT_EQ(status(second), Status::running);
}

TEST_P(LeasesTest, AnAttemptThatMaySucceedNextTimeIsRepeated) {
    const std::string id = submit();
    m_queue.fail(lease(), {"died", "signal 11"}, true);
    EXPECT_EQ(status(id), Status::queued);
    m_queue.fail(lease(), {"died", "signal 11"}, true);
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_reports.find(id)->error->detail, "signal 11");
}

TEST_P(LeasesTest, AnAttemptThatCannotSucceedIsNotRepeated) {
    const std::string id = submit();
    m_queue.fail(lease(), {"unsupported", ""}, false);
    EXPECT_EQ(status(id), Status::failed);
}

TEST_P(LeasesTest, AReturnedJobDoesNotCountAsTried) {
    const std::string id = submit();
    for (int i = 0; i < 5; ++i) {
        const Lease job = lease();
        EXPECT_EQ(job.attempt, 1);
        m_queue.release(job);
        EXPECT_EQ(status(id), Status::queued);
    }
}

TEST_P(LeasesTest, AQueuedJobIsCancelledAtOnce) {
    const std::string id = submit();
    EXPECT_EQ(m_reports.remove(id), Removal::cancelled);
    EXPECT_EQ(status(id), Status::cancelled);
    EXPECT_FALSE(m_queue.lease("worker"));
    EXPECT_EQ(m_reports.remove(id), Removal::deleted);
}

TEST_P(LeasesTest, ARunningJobIsCancelledByItsWorker) {
    const std::string id = submit();
    const Lease job = lease();
    EXPECT_EQ(m_reports.remove(id), Removal::cancelling);
    EXPECT_EQ(m_reports.remove(id), Removal::cancelling);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_queue.state(job), LeaseState::cancel_requested);
    EXPECT_EQ(m_queue.heartbeat(job, 0.5, ""), LeaseState::cancel_requested);
    m_queue.cancel(job);
    EXPECT_EQ(status(id), Status::cancelled);
}

TEST_P(LeasesTest, ACancelledJobStaysCancelledHoweverItsAttemptEnds) {
    const auto cancelled_running = [this] {
        submit();
        const Lease job = lease();
        m_reports.remove(job.id);
        return job;
    };
    const Lease done = cancelled_running();
    EXPECT_FALSE(m_queue.commit(done, finished(done, "picture")));
    EXPECT_EQ(status(done.id), Status::cancelled);
    const Lease failed = cancelled_running();
    m_queue.fail(failed, {"died", ""}, true);
    EXPECT_EQ(status(failed.id), Status::cancelled);
    const Lease released = cancelled_running();
    m_queue.release(released);
    EXPECT_EQ(status(released.id), Status::cancelled);
    const Lease lost = cancelled_running();
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_FALSE(m_queue.lease("next"));
    EXPECT_EQ(status(lost.id), Status::cancelled);
}

TEST_P(LeasesTest, ACommitIsCompleteOrNotMadeAtAll) {
    const std::string id = submit();
    const Lease job = lease();
    FinishedReport report = finished(job, "there");
    report.blobs.push_back({sha256_hex("missing"), "image/png"});
    EXPECT_THROW(m_queue.commit(job, report), StoreError);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_FALSE(m_blobs.open(sha256_hex("there")));
    report.blobs.pop_back();
    EXPECT_TRUE(m_queue.commit(job, report));
    EXPECT_TRUE(m_blobs.open(sha256_hex("there")));
}

TEST_P(LeasesTest, AFinishedJobCountsAsRendering) {
    EXPECT_FALSE(m_readiness.last_rendered_ms());
    make_done("done", "picture");
    EXPECT_EQ(m_readiness.last_rendered_ms(), m_now_ms);
    m_now_ms += 5;
    m_readiness.note_rendered();
    EXPECT_EQ(m_readiness.last_rendered_ms(), m_now_ms);
}

INSTANTIATE_TEST_SUITE_P(Stores, LeasesTest, every_store, store_name);

TEST(LeaseRulesTest, DecideOnALostAttempt) {
    const LeaseRules rules{.max_attempts = 2};
    EXPECT_EQ(after_lost_attempt(1, false, rules), Status::queued);
    EXPECT_EQ(after_lost_attempt(2, false, rules), Status::failed);
    EXPECT_EQ(after_lost_attempt(1, true, rules), Status::cancelled);
}

}  // namespace
}  // namespace sheer::test::leases_test
