// How every store handles reports.
#include <chrono>
#include <thread>

#include "renderer/core/sha256.h"
#include "store_fixture.h"

namespace sheer::test::archive_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using Outcome = SubmitResult::Outcome;
using Removal = ReportArchive::Removal;

class ArchiveTest : public StoreTest {
  protected:
    std::vector<std::string> titles(const ListFilter& filter) {
        std::vector<std::string> all;
        for (const ReportSummary& summary : m_reports.list(filter).reports) all.push_back(summary.title);
        return all;
    }
};

using Titles = std::vector<std::string>;

TEST_P(ArchiveTest, AQueuedReportIsFoundWithItsSpec) {
    const std::string id = submit("first");
    const auto record = m_reports.find(id);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->status, Status::queued);
    EXPECT_EQ(record->created_ms, m_now_ms);
    EXPECT_EQ(json::parse(record->spec)["title"], "first");
    EXPECT_EQ(record->spec_sha256, "hash of first");
    EXPECT_FALSE(record->finished_ms);
    EXPECT_FALSE(m_reports.find("01900000-0000-7000-8000-000000000000"));
}

TEST_P(ArchiveTest, TheQueueIsLimited) {
    const auto report = [&] { return NewReport{.id = m_ids.next(), .spec = "{}", .spec_sha256 = ""}; };
    EXPECT_EQ(m_queue.submit(report(), 2).outcome, Outcome::created);
    EXPECT_EQ(m_queue.submit(report(), 2).outcome, Outcome::created);
    EXPECT_EQ(m_queue.submit(report(), 2).outcome, Outcome::queue_full);
    EXPECT_EQ(m_reports.list({}).reports.size(), 2u);
    lease();  // a running job is no longer waiting
    EXPECT_EQ(m_queue.submit(report(), 2).outcome, Outcome::created);
}

TEST_P(ArchiveTest, AKeyNamesOneReportAndOneBody) {
    NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "", .idempotency = IdempotencyKey{"key", "body"}};
    const std::string id = report.id;
    EXPECT_EQ(m_queue.submit(report, 1).outcome, Outcome::created);
    report.id = m_ids.next();
    const SubmitResult repeated = m_queue.submit(report, 1);  // although the queue is full
    EXPECT_EQ(repeated.outcome, Outcome::repeated);
    EXPECT_EQ(repeated.id, id);
    report.idempotency->body_sha256 = "other";
    EXPECT_EQ(m_queue.submit(report, 1).outcome, Outcome::key_reused);
    EXPECT_EQ(m_reports.list({}).reports.size(), 1u);
}

TEST_P(ArchiveTest, TheListIsNewestFirstAndComesInPages) {
    for (const char* title : {"a", "b", "c", "d", "e"}) submit(title);
    ReportPage page = m_reports.list({.limit = 2});
    EXPECT_EQ(page.reports[0].title, "e");
    EXPECT_EQ(page.reports[1].title, "d");
    EXPECT_TRUE(page.more);
    submit("newer than the page");  // does not change the following pages
    page = m_reports.list({.before_id = page.reports[1].id, .limit = 2});
    EXPECT_EQ(page.reports[0].title, "c");
    EXPECT_EQ(page.count, 6) << "all pages together, with those that came later";
    page = m_reports.list({.before_id = page.reports[1].id, .limit = 2});
    ASSERT_EQ(page.reports.size(), 1u);
    EXPECT_EQ(page.reports[0].title, "a");
    EXPECT_FALSE(page.more);
}

TEST_P(ArchiveTest, NothingFollowsAFullLastPage) {
    submit("a");
    submit("b");
    EXPECT_FALSE(m_reports.list({.limit = 2}).more);
}

TEST_P(ArchiveTest, TheListIsFiltered) {
    submit("Alpha 100%", {{"tags", {{"branch", "main"}}}});
    submit("beta", {{"scene", {{"type", "layers"}}}, {"tags", {{"branch", "topic"}}}});
    submit("gamma", {{"methods", {{{"id", "f2b"}}, {{"id", "b2f"}}}}});
    EXPECT_EQ(m_reports.list({.q = "a", .limit = 1}).count, 3);
    EXPECT_EQ(m_reports.list({.q = "topi"}).count, 1);
    EXPECT_EQ(titles({.q = "ALPHA"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.q = "topi"}), (Titles{"beta"}));
    EXPECT_EQ(titles({.q = "0%"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.q = "%"}), (Titles{"Alpha 100%"}));  // no wildcard
    EXPECT_EQ(titles({.tag = "branch"}), (Titles{"beta", "Alpha 100%"}));
    EXPECT_EQ(titles({.tag = "branch:main"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.tag = "branch:mai"}), Titles{});
    EXPECT_EQ(titles({.method = "F2B"}), (Titles{"gamma"}));
    EXPECT_EQ(titles({.scene = "layers"}), (Titles{"beta"}));
    lease();
    EXPECT_EQ(titles({.status = Status::running}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.method = "b2f", .status = Status::queued}), (Titles{"gamma", "beta"}));
    EXPECT_EQ(titles({.q = "' OR 1 --"}), Titles{});
}

TEST_P(ArchiveTest, ALineOfTheListSaysWhatTheReportIsAbout) {
    make_done("done", "picture");
    const ReportSummary line = m_reports.list({}).reports.at(0);
    EXPECT_EQ(line.scene, "quads");
    EXPECT_EQ(line.methods, (Titles{"b2f"}));
    EXPECT_EQ(line.verdict, "passed");
    EXPECT_EQ(line.preview["sha256"], sha256_hex("picture"));
    EXPECT_EQ(line.finished_ms, m_now_ms);
}

TEST_P(ArchiveTest, APictureIsDeletedWithTheLastReportThatNamesIt) {
    const std::string first = make_done("first", "shared"), second = make_done("second", "shared");
    const std::string sha256 = sha256_hex("shared");
    ASSERT_TRUE(m_blobs.open(sha256));
    EXPECT_EQ(m_reports.remove(first), Removal::deleted);
    EXPECT_FALSE(m_reports.find(first));
    ASSERT_TRUE(m_blobs.open(sha256));
    EXPECT_EQ(picture(sha256), "shared");
    EXPECT_EQ(m_reports.remove(second), Removal::deleted);
    EXPECT_FALSE(m_blobs.open(sha256));
    EXPECT_EQ(m_reports.remove(second), Removal::not_found);
}

TEST_P(ArchiveTest, StoredDataIsThereForTheNextProcess) {
    const std::string done = make_done("done", "picture"), queued = submit("queued");
    const auto next = m_place->open(m_rules, m_clock);
    EXPECT_EQ(next->reports().find(done)->status, Status::done);
    EXPECT_EQ(next->reports().find(done)->report, m_reports.find(done)->report);
    EXPECT_EQ(next->queue().lease("other")->id, queued);
}

TEST_P(ArchiveTest, ChangesByOtherProcessesAreNoticed) {
    const auto other = m_place->open(m_rules, m_clock);
    const auto watch = m_store.watch();
    EXPECT_FALSE(watch->wait(10ms));
    other->readiness().note_rendered();
    EXPECT_TRUE(watch->wait(5s));
    EXPECT_FALSE(watch->wait(10ms));
    submit("own changes as well");
    EXPECT_TRUE(watch->wait(5s));
    std::thread writer([&] {
        std::this_thread::sleep_for(20ms);
        other->readiness().note_rendered();
    });
    EXPECT_TRUE(watch->wait(5s));
    writer.join();
}

TEST_P(ArchiveTest, APictureThatIsOpenStaysReadable) {
    const std::string id = make_done("done", "a picture");
    const Blob blob = m_blobs.open(sha256_hex("a picture")).value();
    EXPECT_EQ(m_reports.remove(id), Removal::deleted);
    EXPECT_EQ(blob.media_type, "image/png");
    EXPECT_EQ(blob.content->size_bytes(), 9u);
    std::string part(7, ' ');
    blob.content->read(2, part);
    EXPECT_EQ(part, "picture");
    EXPECT_THROW(blob.content->read(3, part), StoreError);
    EXPECT_THROW(read_all(*blob.content, 8), StoreError);
    EXPECT_EQ(read_all(*blob.content, 9), "a picture");
}

TEST_P(ArchiveTest, NamesThatAreNotHashesFindNothing) {
    for (const char* name : {"", "../../etc/passwd", "ab"}) {
        EXPECT_FALSE(m_blobs.open(name));
        EXPECT_FALSE(m_assets.open(name));
        EXPECT_FALSE(m_assets.find(name));
        EXPECT_EQ(m_assets.remove(name), Assets::Removal::not_found);
    }
}

INSTANTIATE_TEST_SUITE_P(Stores, ArchiveTest, every_store, store_name);

TEST(ReportIds, GrowEvenIfTheClockDoesNot) {
    std::int64_t now_ms = 5;
    ReportIds ids([&] { return now_ms; });
    std::string last = ids.next();
    EXPECT_EQ(last.substr(0, 13), "00000000-0005");
    for (int i = 0; i < 10'000; ++i) {
        if (i == 5'000) now_ms = 1;
        const std::string id = ids.next();
        ASSERT_LT(last, id);
        ASSERT_TRUE(is_report_id(id));
        ASSERT_EQ(id[14], '7');
        last = id;
    }
}

TEST(ReportIds, DifferBeyondTheTime) {
    ReportIds ids([] { return 5; });
    EXPECT_NE(ids.next().substr(19), ids.next().substr(19));
}

TEST(ReportIds, OtherTextsAreNotIds) {
    EXPECT_FALSE(is_report_id(""));
    EXPECT_FALSE(is_report_id("../../../../../../../../etc/passwd-x"));
    EXPECT_FALSE(is_report_id("01900000-0000-7000-8000-00000000000G"));
}

TEST(Clock, TimesAreWrittenInUtc) {
    EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(utc_text(1'709'210'096'007), "2024-02-29T12:34:56.007Z");
}

}  // namespace
}  // namespace sheer::test::archive_test
