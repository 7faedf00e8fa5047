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
    EXPECT_EQ(record->spec_sha256, sha256_hex(record->spec));
    EXPECT_FALSE(record->finished_ms);
    EXPECT_FALSE(m_reports.find("01900000-0000-7000-8000-000000000000"));
}

TEST_P(ArchiveTest, TheQueueIsLimited) {
    const auto report = [&] { return NewReport{.id = m_ids.next(), .spec = "{}", .spec_sha256 = ""}; };
    EXPECT_EQ(m_queue.submit(report(), {2}).outcome, Outcome::created);
    EXPECT_EQ(m_queue.submit(report(), {2}).outcome, Outcome::created);
    EXPECT_EQ(m_queue.submit(report(), {2}).outcome, Outcome::queue_full);
    EXPECT_EQ(m_reports.list({}).reports.size(), 2u);
    lease();  // a running job is no longer waiting
    EXPECT_EQ(m_queue.submit(report(), {2}).outcome, Outcome::created);
}

TEST_P(ArchiveTest, TheCostOfTheQueueIsLimited) {
    const auto submitted = [&](double cost_mpx) {
        NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = ""};
        report.cost_mpx = cost_mpx;
        return m_queue.submit(report, {.jobs = 10, .cost_mpx = 100}).outcome;
    };
    EXPECT_EQ(submitted(60.5), Outcome::created);
    EXPECT_EQ(submitted(39.5), Outcome::created);
    EXPECT_EQ(submitted(0.25), Outcome::queue_full);
    lease();  // the first one
    EXPECT_EQ(submitted(60.75), Outcome::queue_full);
    EXPECT_EQ(submitted(60.5), Outcome::created);
    lease();
    lease();
    EXPECT_EQ(submitted(1000), Outcome::created) << "what is too much beside others is not too much alone";
}

TEST_P(ArchiveTest, AKeyNamesOneReportAndOneBody) {
    NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "", .idempotency = IdempotencyKey{"key", "body"}};
    const std::string id = report.id;
    EXPECT_EQ(m_queue.submit(report, {1}).outcome, Outcome::created);
    report.id = m_ids.next();
    const SubmitResult repeated = m_queue.submit(report, {1});  // although the queue is full
    EXPECT_EQ(repeated.outcome, Outcome::repeated);
    EXPECT_EQ(repeated.id, id);
    report.idempotency->body_sha256 = "other";
    EXPECT_EQ(m_queue.submit(report, {1}).outcome, Outcome::key_reused);
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
    EXPECT_EQ(m_reports.list({.q = "a", .limit = 1}).count, 1);
    EXPECT_EQ(m_reports.list({.q = "topi"}).count, 1);
    EXPECT_EQ(titles({.q = "ALPHA"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.q = "topi"}), (Titles{"beta"}));
    EXPECT_EQ(titles({.q = "100% alp"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.q = "lpha"}), Titles{});
    submit("antidisestablishment");
    EXPECT_EQ(titles({.q = "antidisestab"}), (Titles{"antidisestablishment"}));
    EXPECT_EQ(titles({.q = "antidisestax"}), Titles{});
    m_reports.remove(m_reports.list({.q = "antidisestab"}).reports.at(0).id);
    EXPECT_EQ(titles({.q = "main alpha"}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.q = "%"}), Titles{});  // neither a word nor a wildcard
    EXPECT_EQ(titles({.tags = {"branch"}}), (Titles{"beta", "Alpha 100%"}));
    EXPECT_EQ(titles({.tags = {"branch:main"}}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.tags = {"branch:mai"}}), Titles{});
    EXPECT_EQ(titles({.methods = {"F2B"}}), (Titles{"gamma"}));
    EXPECT_EQ(titles({.scene = "layers"}), (Titles{"beta"}));
    lease();
    EXPECT_EQ(titles({.status = Status::running}), (Titles{"Alpha 100%"}));
    EXPECT_EQ(titles({.methods = {"b2f"}, .status = Status::queued}), (Titles{"gamma", "beta"}));
    EXPECT_EQ(titles({.q = "' OR 1 --"}), Titles{});
    EXPECT_EQ(titles({.methods = {"f2b", "b2f"}}), (Titles{"gamma"}));
    EXPECT_EQ(titles({.tags = {"branch", "branch:topic"}, .scene = "layers"}), (Titles{"beta"}));
    EXPECT_EQ(titles({.tags = {"branch:main", "branch:topic"}}), Titles{});
    EXPECT_EQ(titles({.q = "b", .scene = "layers"}), (Titles{"beta"}));
    EXPECT_EQ(titles({.spec_sha256 = sha256_of("gamma")}), (Titles{"gamma"}));
}

TEST_P(ArchiveTest, IsSearchedByTimeVerdictAndDevice) {
    const std::int64_t begin_ms = m_now_ms;
    for (const auto& [title, verdict, device] :
         std::vector<std::array<std::string, 3>>{{"one", "passed", "llvmpipe (LLVM 15.0.6, 256 bits)"},
                                                 {"two", "failed", "NVIDIA H100"},
                                                 {"three", "passed", "NVIDIA H100"}}) {
        submit(title);
        const Lease job = lease();
        FinishedReport report = finished(job, title);
        report.report["verdict"] = verdict;
        report.report["device"] = {{"renderer", device}};
        ASSERT_TRUE(m_queue.commit(job, report));
    }
    EXPECT_EQ(titles({.since_ms = begin_ms + 2}), (Titles{"three", "two"}));
    EXPECT_EQ(titles({.until_ms = begin_ms + 2}), (Titles{"two", "one"}));
    EXPECT_EQ(titles({.since_ms = begin_ms + 2, .until_ms = begin_ms + 2}), (Titles{"two"}));
    EXPECT_EQ(titles({.verdict = "passed"}), (Titles{"three", "one"}));
    EXPECT_EQ(titles({.device = "nvidia", .verdict = "passed"}), (Titles{"three"}));
    EXPECT_EQ(titles({.device = "NVIDIA H100"}), (Titles{"three", "two"}));
    EXPECT_EQ(titles({.device = "llvmpipe"}), (Titles{"one"}));
    EXPECT_EQ(titles({.device = "llvm"}), (Titles{"one"}));
    EXPECT_EQ(titles({.device = "nvid"}), Titles{});
    EXPECT_EQ(m_reports.list({}).reports.at(0).device, "NVIDIA H100");
    EXPECT_EQ(m_reports.remove(m_reports.list({}).reports.at(0).id), Removal::deleted);
    EXPECT_EQ(titles({.device = "nvidia"}), (Titles{"two"}));
    EXPECT_EQ(m_reports.list({.device = "nvidia"}).count, 1);
    EXPECT_EQ(m_reports.list({}).count, 2);
    EXPECT_TRUE(m_reports.list({}).count_is_exact);
}

TEST_P(ArchiveTest, APinnedReportIsNotDeleted) {
    const std::string id = make_done("kept", "picture"), queued = submit("queued");
    Pins& pins = m_store.pins();
    EXPECT_EQ(pins.pin({"01900000-0000-7000-8000-000000000000"}), Pins::Pinning::not_found);
    EXPECT_EQ(pins.pin({queued}), Pins::Pinning::not_final);
    EXPECT_EQ(pins.pin({id, 0, "me", "the first"}), Pins::Pinning::added);
    m_now_ms += 5;
    EXPECT_EQ(pins.pin({id, 0, "you", "the best"}), Pins::Pinning::renewed);
    EXPECT_EQ(pins.find(id)->by, "you");
    EXPECT_EQ(pins.find(id)->pinned_ms, m_now_ms);
    EXPECT_TRUE(m_reports.list({.status = Status::done}).reports.at(0).pinned);
    EXPECT_FALSE(m_reports.list({.status = Status::queued}).reports.at(0).pinned);
    EXPECT_EQ(m_reports.remove(id), Removal::pinned);
    EXPECT_TRUE(pins.unpin(id));
    EXPECT_FALSE(pins.unpin(id));
    EXPECT_FALSE(pins.find(id));
    EXPECT_EQ(m_reports.remove(id), Removal::deleted);
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
    const std::string first = submit("first"), second = submit("second");
    const auto watch = m_store.watch();
    EXPECT_FALSE(watch->wait(10ms));
    other->reports().remove(first);
    EXPECT_TRUE(watch->wait(5s));
    EXPECT_FALSE(watch->wait(10ms));
    submit("own changes as well");
    EXPECT_TRUE(watch->wait(5s));
    std::thread writer([&] {
        std::this_thread::sleep_for(20ms);
        other->reports().remove(second);
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
    EXPECT_EQ(time_of_utc_text("2024-02-29T12:34:56.007Z"), 1'709'210'096'007);
    EXPECT_EQ(time_of_utc_text("2024-02-29T12:34:56Z"), 1'709'210'096'000);
    EXPECT_EQ(time_of_utc_text("2024-02-29"), 1'709'164'800'000);
    for (const char* wrong : {"", "2023-02-29", "2024-02-29T24:00:00Z", "2024-02-29T12:34:56", "2024-02-29T12:34:56+0Z",
                              "yesterday", "2024-13-01"})
        EXPECT_FALSE(time_of_utc_text(wrong)) << wrong;
}

}  // namespace
}  // namespace sheer::test::archive_test
