// Jobs that the machine, not their spec, keeps from coming through.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "server/archive/disk_room.h"
#include "store_fixture.h"

namespace sheer::test::setbacks_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::uint64_t kib = 1024, mib = 1024 * kib;
const JobError no_room{"The report could not be kept", "The archive's disk is full."};

TEST(DiskRoomTest, ADiskIsFullBeforeItsLastByte) {
    const auto lack = [](std::uint64_t total, std::uint64_t free) {
        return lack_of_room(DiskSpace{.total_bytes = total, .free_bytes = free});
    };
    EXPECT_EQ(lack(mib, 256 * kib), "");
    EXPECT_THAT(lack(mib, 256 * kib - 1), HasSubstr("255 KiB left and needs 256 KiB"));
    EXPECT_EQ(lack(100 * 1024 * mib, 32 * mib), "");
    EXPECT_NE(lack(100 * 1024 * mib, 32 * mib - 1), "");
    EXPECT_NE(lack(64 * mib, 0), "");
}

TEST(DiskRoomTest, SoIsOneWithoutInodes) {
    const auto lack = [](std::uint64_t total, std::uint64_t free) {
        return lack_of_room(
            DiskSpace{.total_bytes = mib, .free_bytes = mib, .total_inodes = total, .free_inodes = free});
    };
    EXPECT_EQ(lack(80, 10), "");
    EXPECT_THAT(lack(80, 9), HasSubstr("inodes"));
    EXPECT_NE(lack(1'000'000, 63), "");
    EXPECT_EQ(lack(1'000'000, 64), "");
    EXPECT_EQ(lack(0, 0), "");  // a file system that does not count them
}

TEST(DiskRoomTest, TheReserveIsMadeAndGivenUp) {
    const TemporaryFolder folder;
    DiskRoom room(folder.path());
    room.restore_reserve();
    const auto reserve = folder.path() / "reserve";
    ASSERT_TRUE(std::filesystem::exists(reserve));
    EXPECT_GE(std::filesystem::file_size(reserve), 96 * kib);
    EXPECT_TRUE(room.give_up_reserve());
    EXPECT_FALSE(std::filesystem::exists(reserve));
    EXPECT_FALSE(room.give_up_reserve());
    room.restore_reserve();
    EXPECT_TRUE(std::filesystem::exists(reserve));
}

class SetbackTest : public StoreTest {
  protected:
    std::string stage(const std::string& id) { return m_store.find(id)->stage; }
};

TEST_F(SetbackTest, AJobThatTheDiskRefusedComesAgainLaterEachTime) {
    const std::string id = submit();
    std::int64_t wait_ms = m_rules.first_setback_ms;
    for (int i = 1; i <= m_rules.max_setbacks; ++i) {
        const Lease job = lease();
        EXPECT_EQ(job.attempt, 1);
        EXPECT_EQ(job.setbacks, i - 1);
        m_store.set_back(job, no_room, false);
        EXPECT_EQ(status(id), Status::queued);
        EXPECT_EQ(stage(id), "waits: The archive's disk is full.");
        m_now_ms += wait_ms - 1;
        EXPECT_FALSE(m_store.lease("worker"));
        m_now_ms += 1;
        wait_ms = std::min(2 * wait_ms, m_rules.longest_setback_ms);
    }
    m_store.set_back(lease(), no_room, false);
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_store.find(id)->error->detail, no_room.detail);
}

TEST_F(SetbackTest, OthersGoOnMeanwhile) {
    const std::string first = submit("first"), second = submit("second");
    m_store.set_back(lease(), no_room, false);
    EXPECT_EQ(lease().id, second);
    m_now_ms += m_rules.first_setback_ms;
    EXPECT_EQ(lease().id, first);
}

TEST_F(SetbackTest, AJobThatIsCancelledWhileItWaitsIsOver) {
    const std::string id = submit();
    const Lease job = lease();
    EXPECT_EQ(m_store.remove(id), RemoveResult::cancelling);
    m_store.set_back(job, no_room, true);
    EXPECT_EQ(status(id), Status::cancelled);
}

TEST_F(SetbackTest, WhoLostTheLeaseSetsNothingBack) {
    const std::string id = submit();
    const Lease lost = lease();
    m_now_ms += m_rules.lease_ms + 1;
    const Lease held = lease("another");
    m_store.set_back(lost, no_room, true);
    EXPECT_EQ(status(id), Status::running);
    EXPECT_EQ(m_store.state(held), LeaseState::held);
}

TEST_F(SetbackTest, NothingIsTakenWhileAReportLacksRoom) {
    const std::string done = make_done("done", "picture");
    submit("too large");
    EXPECT_EQ(m_store.lack_of_room(), "");
    m_store.set_back(lease(), no_room, true);
    EXPECT_THAT(m_store.lack_of_room(), HasSubstr("did not fit"));
    NewReport next{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "x"};
    EXPECT_THROW(m_store.submit(next, 100), StoreFull);
    EXPECT_THROW(m_store.add_asset({.sha256 = sha256_hex("a"), .facts = json::object()}, "a"), StoreFull);
    // A deletion makes room, and the job need not wait any longer.
    EXPECT_EQ(m_store.remove(done), RemoveResult::deleted);
    EXPECT_EQ(m_store.lack_of_room(), "");
    EXPECT_EQ(m_store.submit(next, 100).outcome, SubmitResult::Outcome::created);
    EXPECT_TRUE(m_store.lease("worker"));
}

TEST_F(SetbackTest, AKeyThatIsKnownIsAnsweredWithoutRoomToo) {
    NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "", .idempotency = IdempotencyKey{"key", "body"}};
    m_store.submit(report, 100);
    m_store.set_back(lease(), no_room, true);
    EXPECT_EQ(m_store.submit(report, 100).outcome, SubmitResult::Outcome::repeated);
}

TEST_F(SetbackTest, ACommitThatFailsLeavesNoPictures) {
    make_done("first", "shared");
    const std::string id = submit("second");
    const Lease job = lease();
    FinishedReport broken = finished(job, "new picture");
    broken.blobs.push_back(finished(job, "shared").blobs[0]);
    broken.blobs.push_back({sha256_hex("gone"), "image/png", m_folder.path() / "not there"});
    const auto files = [this] { return TemporaryFolder::count_files(m_folder.path() / "data/blobs"); };
    EXPECT_THROW(m_store.commit(job, broken), StoreError);
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(status(id), Status::running);
    // One that comes too late leaves none either.
    m_now_ms += m_rules.lease_ms + 1;
    lease("another");
    EXPECT_FALSE(m_store.commit(job, finished(job, "new picture")));
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(read_file(m_store.find_blob(sha256_hex("shared"))->path, 100), "shared");
}

TEST_F(SetbackTest, ASpecThatKillsTwiceInTheSameWayIsNotTriedAgain) {
    const JobError died{"Rendering failed", "The renderer died (signal 11)."};
    const std::string first = submit("deadly");
    m_store.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(first), Status::queued);
    m_store.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(first), Status::failed);
    // The same spec in a report of its own: known.
    const std::string again = submit("deadly");
    m_store.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(again), Status::failed);
    EXPECT_EQ(m_store.find(again)->error->detail, died.detail);
    // Another signal, another spec: neither is.
    const std::string otherwise = submit("deadly");
    m_store.fail_by_signal(lease(), died, 9);
    EXPECT_EQ(status(otherwise), Status::queued);
    m_store.cancel(lease());
    const std::string other = submit("harmless");
    m_store.fail_by_signal(lease(), died, 11);
    EXPECT_EQ(status(other), Status::queued);
}

TEST_F(SetbackTest, ADeathThatWasSurvivedIsForgotten) {
    const JobError died{"Rendering failed", "The renderer died (signal 9)."};
    submit("unlucky");
    m_store.fail_by_signal(lease(), died, 9);
    const Lease second = lease();
    EXPECT_TRUE(m_store.commit(second, finished(second, "picture")));
    const std::string again = submit("unlucky");
    m_store.fail_by_signal(lease(), died, 9);
    EXPECT_EQ(status(again), Status::queued);
}

}  // namespace
}  // namespace sheer::test::setbacks_test
