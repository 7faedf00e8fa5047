// What every store counts of the holders of tokens.
#include "store_fixture.h"

namespace sheer::test::usage_test {
namespace {

using Outcome = SubmitResult::Outcome;

class UsageTest : public StoreTest {
  protected:
    SubmitResult send(const Sender& sender, std::optional<IdempotencyKey> key = std::nullopt) {
        NewReport report{.id = m_ids.next(),
                         .spec = R"({"title": "", "scene": {"type": "quads"}, "methods": [{"id": "b2f"}]})"};
        report.spec_sha256 = sha256_hex(report.spec);
        report.idempotency = std::move(key);
        report.sender = sender;
        return m_queue.submit(report, {100});
    }

    TokenUse use(const std::string& token = "ci") { return m_store.usage().of(token); }
};

TEST_P(UsageTest, WhoSentNothingUsesNothing) {
    submit("without a token");
    EXPECT_EQ(use().jobs, 0);
    EXPECT_EQ(use().seconds, 0);
    EXPECT_EQ(use().upload_bytes, 0);
    EXPECT_FALSE(use().less_at_ms);
}

TEST_P(UsageTest, JobsCountUntilTheyEnd) {
    const Sender two{.token = "ci", .max_jobs = 2};
    EXPECT_EQ(send(two).outcome, Outcome::created);
    EXPECT_EQ(send(two).outcome, Outcome::created);
    EXPECT_EQ(send(two).outcome, Outcome::too_many_jobs);
    EXPECT_EQ(send({.token = "other", .max_jobs = 1}).outcome, Outcome::created) << "each has its own";
    EXPECT_EQ(use().jobs, 2);
    const Lease job = lease();
    EXPECT_EQ(send(two).outcome, Outcome::too_many_jobs) << "it runs";
    ASSERT_TRUE(m_queue.commit(job, finished(job, "a picture")));
    EXPECT_EQ(use().jobs, 1);
    EXPECT_EQ(send(two).outcome, Outcome::created);
    EXPECT_EQ(send({.token = "ci"}).outcome, Outcome::created) << "without a limit";
}

TEST_P(UsageTest, ARepeatedRequestIsNotANewJob) {
    const Sender one{.token = "ci", .max_jobs = 1};
    const IdempotencyKey key{"key", "body"};
    const SubmitResult first = send(one, key), again = send(one, key);
    EXPECT_EQ(first.outcome, Outcome::created);
    EXPECT_EQ(again.outcome, Outcome::repeated);
    EXPECT_EQ(again.id, first.id);
}

TEST_P(UsageTest, RenderingIsCountedHoweverItEnds) {
    const Sender sender{.token = "ci", .max_seconds = 30};
    const auto run = [&](const auto& end) {
        ASSERT_EQ(send(sender).outcome, Outcome::created);
        const Lease job = lease();
        m_now_ms += 2'000;
        m_queue.heartbeat(job, 0.5, "timing");
        m_now_ms += 3'000;
        end(job);
    };
    run([&](const Lease& job) { m_queue.commit(job, finished(job, "a picture")); });
    EXPECT_DOUBLE_EQ(use().seconds, 5);
    run([&](const Lease& job) { m_queue.fail(job, {"no", "no"}, false); });
    EXPECT_DOUBLE_EQ(use().seconds, 10);
    run([&](const Lease& job) { m_queue.cancel(job); });
    EXPECT_DOUBLE_EQ(use().seconds, 15);
    run([&](const Lease& job) { m_queue.fail_by_signal(job, {"no", "no"}, 9); });
    EXPECT_DOUBLE_EQ(use().seconds, 20);
    const Lease again = lease();
    m_now_ms += 9'001;
    m_queue.cancel(again);
    EXPECT_DOUBLE_EQ(use().seconds, 29.001);
    EXPECT_EQ(send(sender).outcome, Outcome::seconds_used_up) << "less than a second is left";
    EXPECT_EQ(send({.token = "ci", .max_seconds = 31}).outcome, Outcome::created);
    EXPECT_EQ(use("other").seconds, 0);
}

TEST_P(UsageTest, ADayIsThisHourAndThe23BeforeIt) {
    constexpr std::int64_t hour_ms = 3'600'000;
    m_now_ms = 1'000 * hour_ms + 1;
    m_store.usage().add_upload("ci", 100);
    m_now_ms += hour_ms;
    m_store.usage().add_upload("ci", 20);
    m_store.usage().add_upload("ci", 3);
    m_store.usage().add_upload("other", 4'000);
    EXPECT_EQ(use().upload_bytes, 123);
    EXPECT_EQ(use().less_at_ms, 1'024 * hour_ms);
    m_now_ms = 1'024 * hour_ms - 1;
    EXPECT_EQ(use().upload_bytes, 123);
    m_now_ms = 1'024 * hour_ms;
    EXPECT_EQ(use().upload_bytes, 23);
    EXPECT_EQ(use().less_at_ms, 1'025 * hour_ms);
    m_now_ms = 1'025 * hour_ms;
    EXPECT_EQ(use().upload_bytes, 0);
    m_store.usage().add_upload("ci", 5);
    EXPECT_EQ(use().upload_bytes, 5);
}

INSTANTIATE_TEST_SUITE_P(Stores, UsageTest, every_store, store_name);

}  // namespace
}  // namespace sheer::test::usage_test
