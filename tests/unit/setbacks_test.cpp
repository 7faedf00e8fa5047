// Jobs that cannot finish because of the machine, not of their spec.
#include <gmock/gmock.h>

#include "store_fixture.h"

namespace sheer::test::setbacks_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Removal = ReportArchive::Removal;

const JobError no_room{"The report could not be kept", "The archive's disk is full."};

class SetbackTest : public StoreTest {
  protected:
    std::string stage(const std::string& id) { return m_reports.find(id)->stage; }
};

TEST_P(SetbackTest, AJobThatTheDiskRefusedIsRetriedAfterIncreasingDelays) {
    const std::string id = submit();
    std::int64_t wait_ms = m_rules.first_setback_ms;
    for (int i = 1; i <= m_rules.max_setbacks; ++i) {
        const Lease job = lease();
        EXPECT_EQ(job.attempt, 1);
        EXPECT_EQ(job.setbacks, i - 1);
        m_queue.set_back(job, no_room, false);
        EXPECT_EQ(status(id), Status::queued);
        EXPECT_EQ(stage(id), "waiting: The archive's disk is full.");
        m_now_ms += wait_ms - 1;
        EXPECT_FALSE(m_queue.lease("worker"));
        m_now_ms += 1;
        wait_ms = std::min(2 * wait_ms, m_rules.longest_setback_ms);
    }
    m_queue.set_back(lease(), no_room, false);
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_reports.find(id)->error->detail, no_room.detail);
}

TEST_P(SetbackTest, OtherJobsContinueMeanwhile) {
    const std::string first = submit("first"), second = submit("second");
    m_queue.set_back(lease(), no_room, false);
    EXPECT_EQ(lease().id, second);
    m_now_ms += m_rules.first_setback_ms;
    EXPECT_EQ(lease().id, first);
}

TEST_P(SetbackTest, AJobThatIsCancelledWhileItWaitsHasEnded) {
    const std::string id = submit();
    const Lease job = lease();
    EXPECT_EQ(m_reports.remove(id), Removal::cancelling);
    m_queue.set_back(job, no_room, true);
    EXPECT_EQ(status(id), Status::cancelled);
}

TEST_P(SetbackTest, AWorkerThatLostItsLeaseCannotSetAJobBack) {
    const std::string id = submit();
    const Lease lost = lease();
    m_now_ms += m_rules.lease_ms + 1;
    const Lease held = lease("another");
    m_queue.set_back(lost, no_room, true);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_queue.state(held), LeaseState::held);
}

TEST_P(SetbackTest, NothingIsAcceptedWhileAReportLacksRoom) {
    const std::string done = make_done("done", "picture");
    submit("too large");
    EXPECT_EQ(m_readiness.lack_of_room(), "");
    m_queue.set_back(lease(), no_room, true);
    EXPECT_THAT(m_readiness.lack_of_room(), HasSubstr("did not fit"));
    NewReport next{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "x"};
    EXPECT_THROW(m_queue.submit(next, {100}), StoreFull);
    EXPECT_THROW(m_assets.add({.sha256 = sha256_hex("a"), .facts = json::object()}, "a"), StoreFull);
    // A deletion makes room, and the job no longer has to wait.
    EXPECT_EQ(m_reports.remove(done), Removal::deleted);
    EXPECT_EQ(m_readiness.lack_of_room(), "");
    EXPECT_EQ(m_queue.submit(next, {100}).outcome, SubmitResult::Outcome::created);
    EXPECT_TRUE(m_queue.lease("worker"));
}

TEST_P(SetbackTest, AKnownKeyIsAnsweredWithoutRoomToo) {
    NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "", .idempotency = IdempotencyKey{"key", "body"}};
    m_queue.submit(report, {100});
    m_queue.set_back(lease(), no_room, true);
    EXPECT_EQ(m_queue.submit(report, {100}).outcome, SubmitResult::Outcome::repeated);
}

TEST_P(SetbackTest, ACommitThatFailsLeavesNoPictures) {
    make_done("first", "shared");
    const std::string id = submit("second");
    const Lease job = lease();
    FinishedReport broken = finished(job, "new picture");
    add_picture(broken, "shared");
    broken.blobs.push_back({sha256_hex("gone"), "image/png"});
    EXPECT_THROW(m_queue.commit(job, broken), StoreError);
    EXPECT_FALSE(m_blobs.open(sha256_hex("new picture")));
    EXPECT_EQ(status(id), Status::running);
    // One that comes too late leaves no pictures either.
    m_now_ms += m_rules.lease_ms + 1;
    lease("another");
    EXPECT_FALSE(m_queue.commit(job, finished(job, "new picture")));
    EXPECT_FALSE(m_blobs.open(sha256_hex("new picture")));
    EXPECT_EQ(picture(sha256_hex("shared")), "shared");
}

TEST_P(SetbackTest, ASpecThatKillsTwiceInTheSameWayIsNotTriedAgain) {
    const JobError died{"Rendering failed", "The renderer died (signal 11)."};
    const std::string first = submit("deadly");
    m_queue.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(first), Status::queued);
    m_queue.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(first), Status::failed);
    // The same spec in another report is recognized.
    const std::string again = submit("deadly");
    m_queue.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(again), Status::failed);
    EXPECT_EQ(m_reports.find(again)->error->detail, died.detail);
    // Another signal or another spec is not.
    const std::string otherwise = submit("deadly");
    m_queue.fail_by_signal(lease(), died, 9);
    EXPECT_EQ(status(otherwise), Status::queued);
    m_queue.cancel(lease());
    const std::string other = submit("harmless");
    m_queue.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(other), Status::queued);
}

TEST_P(SetbackTest, ACrashIsForgottenAfterASuccess) {
    const JobError died{"Rendering failed", "The renderer died (signal 9)."};
    submit("unlucky");
    m_queue.fail_by_signal(lease(), died, 9);
    const Lease second = lease();
    EXPECT_TRUE(m_queue.commit(second, finished(second, "picture")));
    const std::string again = submit("unlucky");
    m_queue.fail_by_signal(lease(), died, 9);
    EXPECT_EQ(status(again), Status::queued);
}

INSTANTIATE_TEST_SUITE_P(Stores, SetbackTest, every_store, store_name);

}  // namespace
}  // namespace sheer::test::setbacks_test
