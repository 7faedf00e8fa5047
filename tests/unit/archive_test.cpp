#include <SQLiteCpp/SQLiteCpp.h>

#include "store_fixture.h"

namespace sheer::test::archive_test {
namespace {

using nlohmann::json;
using Outcome = SubmitResult::Outcome;

class ArchiveTest : public StoreTest {
  protected:
    std::vector<std::string> titles(const ListFilter& filter) {
        std::vector<std::string> all;
        for (const ReportSummary& summary : m_store.list(filter).reports) all.push_back(summary.title);
        return all;
    }
};

using Titles = std::vector<std::string>;

TEST_F(ArchiveTest, AQueuedReportIsFoundWithItsSpec) {
    const std::string id = submit("first");
    const auto record = m_store.find(id);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->status, Status::queued);
    EXPECT_EQ(record->created_ms, m_now_ms);
    EXPECT_EQ(json::parse(record->spec)["title"], "first");
    EXPECT_EQ(record->spec_sha256, "hash of first");
    EXPECT_FALSE(record->finished_ms);
    EXPECT_FALSE(m_store.find("01900000-0000-7000-8000-000000000000"));
}

TEST_F(ArchiveTest, TheQueueHasAnEnd) {
    const auto report = [&] { return NewReport{.id = m_ids.next(), .spec = "{}", .spec_sha256 = ""}; };
    EXPECT_EQ(m_store.submit(report(), 2).outcome, Outcome::created);
    EXPECT_EQ(m_store.submit(report(), 2).outcome, Outcome::created);
    EXPECT_EQ(m_store.submit(report(), 2).outcome, Outcome::queue_full);
    EXPECT_EQ(m_store.list({}).reports.size(), 2u);
    lease();  // a job that runs waits no longer
    EXPECT_EQ(m_store.submit(report(), 2).outcome, Outcome::created);
}

TEST_F(ArchiveTest, AKeyNamesOneReportAndOneBody) {
    NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = "", .idempotency = IdempotencyKey{"key", "body"}};
    const std::string id = report.id;
    EXPECT_EQ(m_store.submit(report, 1).outcome, Outcome::created);
    report.id = m_ids.next();
    const SubmitResult repeated = m_store.submit(report, 1);  // though the queue is full
    EXPECT_EQ(repeated.outcome, Outcome::repeated);
    EXPECT_EQ(repeated.id, id);
    report.idempotency->body_sha256 = "other";
    EXPECT_EQ(m_store.submit(report, 1).outcome, Outcome::key_reused);
    EXPECT_EQ(m_store.list({}).reports.size(), 1u);
}

TEST_F(ArchiveTest, TheListIsNewestFirstAndComesInPages) {
    for (const char* title : {"a", "b", "c", "d", "e"}) submit(title);
    ReportPage page = m_store.list({.limit = 2});
    EXPECT_EQ(page.reports[0].title, "e");
    EXPECT_EQ(page.reports[1].title, "d");
    EXPECT_TRUE(page.more);
    submit("newer than the page");  // does not move what comes after a page
    page = m_store.list({.before_id = page.reports[1].id, .limit = 2});
    EXPECT_EQ(page.reports[0].title, "c");
    page = m_store.list({.before_id = page.reports[1].id, .limit = 2});
    ASSERT_EQ(page.reports.size(), 1u);
    EXPECT_EQ(page.reports[0].title, "a");
    EXPECT_FALSE(page.more);
}

TEST_F(ArchiveTest, TheLastPageThatIsFullHasNoneAfterIt) {
    submit("a");
    submit("b");
    EXPECT_FALSE(m_store.list({.limit = 2}).more);
}

TEST_F(ArchiveTest, TheListIsFiltered) {
    submit("Alpha 100%", {{"tags", {{"branch", "main"}}}});
    submit("beta", {{"scene", {{"type", "layers"}}}, {"tags", {{"branch", "topic"}}}});
    submit("gamma", {{"methods", {{{"id", "f2b"}}, {{"id", "b2f"}}}}});
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

TEST_F(ArchiveTest, ALineOfTheListSaysWhatTheReportIsAbout) {
    make_done("done", "picture");
    const ReportSummary line = m_store.list({}).reports.at(0);
    EXPECT_EQ(line.scene, "quads");
    EXPECT_EQ(line.methods, (Titles{"b2f"}));
    EXPECT_EQ(line.verdict, "passed");
    EXPECT_EQ(line.preview["sha256"], sha256_hex("picture"));
    EXPECT_EQ(line.finished_ms, m_now_ms);
}

TEST_F(ArchiveTest, APictureIsDeletedWithTheLastReportThatNamesIt) {
    const std::string first = make_done("first", "shared"), second = make_done("second", "shared");
    const std::string sha256 = sha256_hex("shared");
    ASSERT_TRUE(m_store.find_blob(sha256));
    EXPECT_EQ(m_store.remove(first), RemoveResult::deleted);
    EXPECT_FALSE(m_store.find(first));
    ASSERT_TRUE(m_store.find_blob(sha256));
    EXPECT_EQ(read_file(m_store.find_blob(sha256)->path, 100), "shared");
    EXPECT_EQ(m_store.remove(second), RemoveResult::deleted);
    EXPECT_FALSE(m_store.find_blob(sha256));
    EXPECT_EQ(TemporaryFolder::count_files(m_folder.path() / "data" / "blobs"), 0);
    EXPECT_EQ(m_store.remove(second), RemoveResult::not_found);
}

TEST_F(ArchiveTest, AFinalReportCannotBeChanged) {
    const std::string id = make_done("done", "picture");
    SQLite::Database database((m_folder.path() / "data" / "archive.sqlite").string(), SQLite::OPEN_READWRITE);
    EXPECT_THROW(database.exec("UPDATE reports SET report = '{}'"), SQLite::Exception);
    EXPECT_THROW(database.exec("UPDATE reports SET status = 'queued', finished_ms = NULL, report = NULL"),
                 SQLite::Exception);
    EXPECT_EQ(json::parse(m_store.find(id)->report)["verdict"], "passed");
}

TEST_F(ArchiveTest, WhatWasStoredIsThereForTheNextProcess) {
    const std::string done = make_done("done", "picture"), queued = submit("queued");
    SqliteStore next(m_folder.path() / "data", m_rules, m_clock);
    EXPECT_EQ(next.find(done)->status, Status::done);
    EXPECT_EQ(next.find(done)->report, m_store.find(done)->report);
    EXPECT_EQ(next.lease("other")->id, queued);
}

TEST_F(ArchiveTest, ChangesOfOthersAreNoticed) {
    SqliteStore other(m_folder.path() / "data", m_rules, m_clock);
    const std::int64_t before = m_store.change_counter();
    EXPECT_EQ(m_store.change_counter(), before);
    other.note_rendered();
    const std::int64_t after = m_store.change_counter();
    EXPECT_NE(after, before);
    submit("own changes as well");
    EXPECT_NE(m_store.change_counter(), after);
}

TEST_F(ArchiveTest, AnArchiveOfALaterVersionIsLeftAlone) {
    const std::filesystem::path folder = m_folder.path() / "later";
    std::filesystem::create_directories(folder);
    {
        SQLite::Database database((folder / "archive.sqlite").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        database.exec("PRAGMA user_version = 99");
    }
    EXPECT_THROW(SqliteStore(folder, m_rules, m_clock), StoreError);
    SQLite::Database database((folder / "archive.sqlite").string());
    EXPECT_FALSE(database.tableExists("reports"));
}

TEST_F(ArchiveTest, AFileThatIsNoDatabaseIsAnError) {
    const TemporaryFolder folder;
    folder.file("archive.sqlite", std::string(4096, 'x'));
    EXPECT_THROW(SqliteStore(folder.path(), m_rules, m_clock), StoreError);
    EXPECT_THROW(SqliteStore(folder.file("file", ""), m_rules, m_clock), StoreError);
}

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

TEST(ReportIds, AreUnlikeEachOtherBeyondTheTime) {
    ReportIds ids([] { return 5; });
    EXPECT_NE(ids.next().substr(19), ids.next().substr(19));
}

TEST(ReportIds, OtherTextsAreNone) {
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
