// How every store handles a report of several devices: a part of each, one after the other, and then joining them.
#include <gmock/gmock.h>

#include "store_fixture.h"

namespace sheer::test::parts_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;
using Removal = ReportArchive::Removal;

class PartsTest : public StoreTest {
  protected:
    std::string submit_for(const std::vector<std::string>& labels) { return submit("many", {{"device", labels}}); }

    Lease lease_as(const std::string& label, const std::string& owner = "") {
        const auto leased = m_queue.lease(owner.empty() ? "worker of " + label : owner, label);
        if (!leased) throw std::runtime_error("no job to lease for " + label);
        return *leased;
    }

    /// Renders the part of this device, with a picture of its own.
    void render(const std::string& label, const std::string& picture) {
        const Lease part = lease_as(label);
        EXPECT_EQ(part.part, label);
        EXPECT_TRUE(m_queue.commit(part, finished(part, picture)));
    }

    std::vector<std::string> states(const std::string& id) {
        std::vector<std::string> all;
        const auto record = m_reports.find(id);
        for (const PartState& part : record->parts)
            all.push_back(part.label + " " + std::string(status_text(part.status)));
        return all;
    }

    bool is_stored(const std::string& picture) { return m_blobs.open(sha256_hex(picture)).has_value(); }

    /// Those that a store keeps nothing of.
    std::vector<std::string> damages() {
        std::vector<std::string> all;
        for (const Finding& finding : m_store.care().check(false).findings) all.push_back(finding.text);
        return all;
    }
    bool is_checked() const { return std::string(GetParam().name) != "Memory"; }
};

TEST_P(PartsTest, EachDeviceRendersOnePartAndAnyWorkerJoinsThem) {
    const std::string id = submit_for({"nvidia", "llvmpipe"});
    EXPECT_THAT(states(id), ElementsAre("nvidia queued", "llvmpipe queued"));
    EXPECT_FALSE(m_queue.lease("other", "amd"));
    EXPECT_FALSE(m_queue.lease("other"));

    const Lease first = lease_as("llvmpipe");
    EXPECT_EQ(first.id, id);
    EXPECT_EQ(first.part, "llvmpipe");
    EXPECT_EQ(first.parts, 2);
    EXPECT_EQ(first.parts_ended, 0);
    EXPECT_FALSE(first.joins());
    EXPECT_THAT(states(id), ElementsAre("nvidia queued", "llvmpipe running"));
    EXPECT_FALSE(m_queue.lease("another", "nvidia")) << "the parts are rendered one after the other";
    EXPECT_TRUE(m_queue.commit(first, finished(first, "by the CPU")));
    EXPECT_EQ(status(id), Status::queued);
    EXPECT_THAT(states(id), ElementsAre("nvidia queued", "llvmpipe done"));
    EXPECT_DOUBLE_EQ(m_reports.find(id)->progress, 1 / 3.0);
    EXPECT_FALSE(m_queue.lease("again", "llvmpipe"));

    render("nvidia", "by the GPU");
    EXPECT_THAT(states(id), ElementsAre("nvidia done", "llvmpipe done"));
    EXPECT_TRUE(is_stored("by the CPU"));
    EXPECT_TRUE(is_stored("by the GPU"));
    if (is_checked()) {
        EXPECT_THAT(damages(), IsEmpty());
    }

    const Lease joining = lease_as("amd");
    EXPECT_TRUE(joining.joins());
    const std::vector<EndedPart> parts = m_queue.ended_parts(joining);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].label, "llvmpipe");
    EXPECT_EQ(parts[1].label, "nvidia");
    for (const EndedPart& part : parts) {
        EXPECT_FALSE(part.error);
        const std::string picture = part.label == "nvidia" ? "by the GPU" : "by the CPU";
        EXPECT_EQ(json::parse(part.report)["runs"][0]["reference"]["images"]["color"]["sha256"], sha256_hex(picture));
    }
    FinishedReport joined = finished(joining, "by the CPU");
    const json other = json::parse(parts[1].report)["runs"][0];
    joined.report["runs"].push_back(other);
    add_picture(joined, "by the GPU");
    EXPECT_TRUE(m_queue.commit(joining, joined));
    EXPECT_EQ(status(id), Status::done);
    EXPECT_THAT(states(id), IsEmpty());
    EXPECT_EQ(picture(sha256_hex("by the CPU")), "by the CPU");
    EXPECT_EQ(picture(sha256_hex("by the GPU")), "by the GPU");
    EXPECT_EQ(m_reports.list({}).count, 1);
    if (is_checked()) {
        EXPECT_THAT(damages(), IsEmpty());
    }
    EXPECT_EQ(m_reports.remove(id), Removal::deleted);
    EXPECT_FALSE(is_stored("by the CPU"));
    EXPECT_FALSE(is_stored("by the GPU"));
}

TEST_P(PartsTest, PartsAreNoReportsOfTheirOwn) {
    const std::string id = submit_for({"a", "b"});
    render("a", "picture");
    EXPECT_EQ(m_reports.list({}).count, 1);
    EXPECT_EQ(m_reports.list({.q = "many"}).count, 1);
    EXPECT_EQ(m_reports.list({.status = Status::done}).count, 0);
    EXPECT_THAT(m_store.trends().reports({.spec_sha256 = sha256_of("many"), .status = Status::done}), IsEmpty());
    EXPECT_THAT(m_store.care().stored_reports(), IsEmpty());
    if (is_checked()) {
        EXPECT_EQ(m_store.care().collect_garbage().rows, 0);
        EXPECT_TRUE(is_stored("picture")) << "it belongs to a part";
    }
}

TEST_P(PartsTest, AJobOfOneDeviceGoesOnBesideIt) {
    submit_for({"a", "b"});
    const std::string next = submit("next");
    const Lease part = lease_as("a");
    EXPECT_EQ(lease_as("b").id, next);
    EXPECT_TRUE(m_queue.commit(part, finished(part, "p")));
    EXPECT_EQ(lease_as("b", "another").id, part.id) << "it has kept its place in the queue";
}

TEST_P(PartsTest, ADeviceThatFailsLeavesTheOthers) {
    const std::string id = submit_for({"a", "b"});
    m_queue.fail(lease_as("a"), {"Rendering failed", "there is no such extension"}, false);
    EXPECT_EQ(status(id), Status::queued);
    EXPECT_THAT(states(id), ElementsAre("a failed", "b queued"));
    EXPECT_EQ(m_reports.find(id)->parts[0].error->detail, "there is no such extension");
    render("b", "picture");
    const Lease joining = lease_as("a");
    EXPECT_TRUE(joining.joins());
    const auto parts = m_queue.ended_parts(joining);
    EXPECT_EQ(parts[0].error->detail, "there is no such extension");
    EXPECT_EQ(parts[0].report, "");
    EXPECT_TRUE(m_queue.commit(joining, finished(joining, "picture")));
    EXPECT_EQ(status(id), Status::done);
}

TEST_P(PartsTest, AReportAllOfWhoseDevicesFailedHasFailed) {
    const std::string id = submit_for({"a", "b"});
    m_queue.fail(lease_as("b"), {"Rendering failed", "no GPU"}, false);
    m_queue.fail(lease_as("a"), {"Rendering took too long", "It was stopped."}, false);
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(m_reports.find(id)->error->title, "Rendering failed on every device");
    const std::string detail = m_reports.find(id)->error->detail;
    EXPECT_THAT(detail, testing::HasSubstr("a: Rendering took too long: It was stopped."));
    EXPECT_THAT(detail, testing::HasSubstr("b: Rendering failed: no GPU"));
    EXPECT_FALSE(m_queue.lease("worker", "a"));
}

TEST_P(PartsTest, EachPartHasAttemptsOfItsOwn) {
    const std::string id = submit_for({"a", "b"});
    for (int i = 1; i <= m_rules.max_attempts; ++i) {
        const Lease part = lease_as("a");
        EXPECT_EQ(part.attempt, i);
        m_now_ms += m_rules.lease_ms + 1;
        EXPECT_EQ(m_queue.state(part), LeaseState::held) << "nobody has taken it";
        m_queue.end_leases_of("worker of a");
    }
    EXPECT_THAT(states(id), ElementsAre("a failed", "b queued"));
    const Lease crashed = lease_as("b");
    EXPECT_EQ(crashed.attempt, 1);
    m_queue.fail_by_signal(crashed, {"died", "signal 11"}, 11);
    EXPECT_THAT(states(id), ElementsAre("a failed", "b queued")) << "it is tried again";
    const Lease again = lease_as("b");
    EXPECT_EQ(again.attempt, 2);
    EXPECT_TRUE(m_queue.commit(again, finished(again, "p")));
    const Lease joining = lease_as("any");
    EXPECT_EQ(joining.attempt, 1);
    m_now_ms += m_rules.lease_ms + 1;
    EXPECT_TRUE(lease_as("another").joins()) << "joining is tried again as well";
}

TEST_P(PartsTest, ASignalOnOneDeviceSaysNothingAboutTheNext) {
    const std::string id = submit_for({"a", "b"});
    m_queue.fail_by_signal(lease_as("a"), {"died", "signal 11"}, 11);
    EXPECT_THAT(states(id), ElementsAre("a queued", "b queued"));
    m_queue.fail_by_signal(lease_as("a"), {"died", "signal 11"}, 11);
    EXPECT_THAT(states(id), ElementsAre("a failed", "b queued"));
    m_queue.fail_by_signal(lease_as("b"), {"died", "signal 11"}, 11);
    EXPECT_THAT(states(id), ElementsAre("a failed", "b queued"));
}

TEST_P(PartsTest, AWorkerThatLostAPartCannotTouchALaterOne) {
    const std::string id = submit_for({"a", "b"});
    const Lease lost = lease_as("a", "same");
    m_now_ms += m_rules.lease_ms + 1;
    const Lease taken = lease_as("a", "other");
    EXPECT_TRUE(m_queue.commit(taken, finished(taken, "p")));
    const Lease later = lease_as("b", "same");  // the same name and the same number of the attempt
    EXPECT_EQ(later.attempt, lost.attempt);
    EXPECT_EQ(m_queue.heartbeat(lost, 0.9, "late"), LeaseState::lost);
    EXPECT_EQ(m_queue.state(lost), LeaseState::lost);
    EXPECT_FALSE(m_queue.commit(lost, finished(lost, "late")));
    m_queue.fail(lost, {"late", "late"}, false);
    m_queue.release(lost);
    m_queue.cancel(lost);
    EXPECT_FALSE(is_stored("late"));
    EXPECT_EQ(m_queue.state(later), LeaseState::held);
    EXPECT_THAT(states(id), ElementsAre("a done", "b running"));
}

TEST_P(PartsTest, CancellingEndsAllParts) {
    const std::string waiting = submit_for({"a", "b"});
    render("a", "of the waiting one");
    EXPECT_EQ(m_reports.remove(waiting), Removal::cancelled);
    EXPECT_EQ(status(waiting), Status::cancelled);
    EXPECT_FALSE(m_queue.lease("worker", "b"));
    EXPECT_FALSE(is_stored("of the waiting one"));

    const std::string running = submit_for({"a", "b"});
    render("a", "of the running one");
    const Lease part = lease_as("b");
    EXPECT_EQ(m_reports.remove(running), Removal::cancelling);
    EXPECT_EQ(m_queue.state(part), LeaseState::cancel_requested);
    EXPECT_FALSE(m_queue.commit(part, finished(part, "too late")));
    EXPECT_EQ(status(running), Status::cancelled);
    for (const char* picture : {"of the running one", "too late"}) EXPECT_FALSE(is_stored(picture)) << picture;
    if (is_checked()) {
        EXPECT_THAT(damages(), IsEmpty());
    }
}

TEST_P(PartsTest, AFullDiskSetsBackOnlyThePart) {
    const std::string id = submit_for({"a", "b"});
    m_queue.set_back(lease_as("a"), {"The report could not be kept", "full"}, false);
    EXPECT_FALSE(m_queue.lease("worker", "a"));
    m_now_ms += m_rules.first_setback_ms;
    const Lease part = lease_as("a");
    EXPECT_EQ(part.setbacks, 1);
    EXPECT_EQ(part.attempt, 1);
    EXPECT_TRUE(m_queue.commit(part, finished(part, "p")));
    EXPECT_EQ(lease_as("b").setbacks, 0);
    EXPECT_THAT(states(id), ElementsAre("a done", "b running"));
}

TEST_P(PartsTest, ItTakesOnePlaceOfItsSender) {
    const json spec = {{"device", {"a", "b"}}, {"scene", {{"type", "quads"}}}, {"methods", json::array()}};
    NewReport report{.id = m_ids.next(), .spec = spec.dump(), .cost_mpx = 4};
    report.spec_sha256 = sha256_hex(report.spec);
    report.sender = Sender{.token = "me", .max_jobs = 1, .max_seconds = {}};
    report.idempotency = IdempotencyKey{"key", "body"};
    using Outcome = SubmitResult::Outcome;
    ASSERT_EQ(m_queue.submit(report, {100}).outcome, Outcome::created);
    EXPECT_EQ(m_queue.submit(report, {100}).outcome, Outcome::repeated);
    render("a", "p");
    EXPECT_EQ(m_store.usage().of("me").jobs, 1) << "it has not ended";
    const Lease part = lease_as("b");
    m_now_ms += 3000;
    m_queue.heartbeat(part, 0.5, "timing");
    EXPECT_DOUBLE_EQ(m_store.usage().of("me").seconds, 3);
    EXPECT_TRUE(m_queue.commit(part, finished(part, "q")));
    const Lease joining = lease_as("a");
    EXPECT_TRUE(m_queue.commit(joining, finished(joining, "p")));
    EXPECT_EQ(m_store.usage().of("me").jobs, 0);
}

INSTANTIATE_TEST_SUITE_P(Stores, PartsTest, every_store, store_name);

}  // namespace
}  // namespace sheer::test::parts_test
