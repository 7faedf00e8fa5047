// Properties of only the SQLite store.
#include <SQLiteCpp/SQLiteCpp.h>

#include <chrono>
#include <future>

#include "store_fixture.h"

namespace sheer::test::sqlite_store_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using Removal = ReportArchive::Removal;

class SqliteStoreTest : public WithSqlite {
  protected:
    int pictures() const { return TemporaryFolder::count_files(m_data.blobs()); }
    int uploads() const { return TemporaryFolder::count_files(m_data.assets()); }
};

TEST_F(SqliteStoreTest, AFinalReportCannotBeChanged) {
    const std::string id = make_done("done", "picture");
    SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
    EXPECT_THROW(database.exec("UPDATE reports SET report = '{}'"), SQLite::Exception);
    EXPECT_THROW(database.exec("UPDATE reports SET status = 'queued', finished_ms = NULL, report = NULL"),
                 SQLite::Exception);
    EXPECT_EQ(json::parse(m_reports.find(id)->report)["verdict"], "passed");
}

TEST_F(SqliteStoreTest, AnArchiveOfALaterVersionIsLeftAlone) {
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

TEST_F(SqliteStoreTest, AFileThatIsNotADatabaseIsAnError) {
    const TemporaryFolder folder;
    folder.file("archive.sqlite", std::string(4096, 'x'));
    EXPECT_THROW(SqliteStore(folder.path(), m_rules, m_clock), StoreError);
    EXPECT_THROW(SqliteStore(folder.file("file", ""), m_rules, m_clock), StoreError);
}

TEST_F(SqliteStoreTest, AnArchiveOfVersionOneIsBroughtUpToDate) {
    const std::string id = submit("kept");
    {
        SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
        database.exec(
            "DROP TABLE baselines; DROP TABLE assets; DROP INDEX reports_that_died; DROP INDEX reports_set_back");
        for (const char* column : {"setbacks", "not_before_ms", "lacks_room", "died_of"})
            database.exec(std::string("ALTER TABLE reports DROP COLUMN ") + column);
        database.exec("PRAGMA user_version = 1; PRAGMA application_id = 0");
    }
    SqliteStore again(m_data.root, m_rules, m_clock);
    EXPECT_TRUE(again.reports().find(id));
    EXPECT_TRUE(again.assets().list(1).empty());
    EXPECT_TRUE(again.baselines().list("").empty());
    EXPECT_TRUE(again.queue().lease("worker"));
}

TEST_F(SqliteStoreTest, FilesAreRemovedWithTheLastReportThatNamesThem) {
    const std::string first = make_done("first", "shared"), second = make_done("second", "shared");
    EXPECT_EQ(pictures(), 1);
    m_reports.remove(first);
    EXPECT_EQ(pictures(), 1);
    m_reports.remove(second);
    EXPECT_EQ(pictures(), 0);
    const std::string asset = add_asset("upload");
    add_asset("upload");
    EXPECT_EQ(uploads(), 1);
    m_assets.remove(asset);
    EXPECT_EQ(uploads(), 0);
}

TEST_F(SqliteStoreTest, ACommitThatFailsLeavesNoFiles) {
    make_done("first", "shared");
    submit("second");
    const Lease job = lease();
    FinishedReport broken = finished(job, "new picture");
    add_picture(broken, "shared");
    broken.blobs.push_back({sha256_hex("gone"), "image/png"});
    EXPECT_THROW(m_queue.commit(job, broken), StoreError);
    EXPECT_EQ(pictures(), 1);
    m_now_ms += m_rules.lease_ms + 1;
    lease("another");
    EXPECT_FALSE(m_queue.commit(job, finished(job, "new picture")));
    EXPECT_EQ(pictures(), 1);
}

/// Another process is writing, and one of our writers waits for it.
TEST_F(SqliteStoreTest, ReadersDoNotWaitForWriters) {
    const std::string id = make_done("done", "picture");
    const auto watch = m_store.watch();
    SQLite::Database other(m_data.database().string(), SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");
    auto writer = std::async(std::launch::async, [this] { m_readiness.note_rendered(); });
    EXPECT_EQ(writer.wait_for(50ms), std::future_status::timeout);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(m_reports.find(id));
    EXPECT_EQ(m_reports.list({}).reports.size(), 1u);
    EXPECT_EQ(picture(sha256_hex("picture")), "picture");
    EXPECT_TRUE(m_assets.list(1).empty());
    EXPECT_EQ(m_readiness.lack_of_room(), "");
    EXPECT_TRUE(m_readiness.last_rendered_ms());
    EXPECT_FALSE(watch->wait(0ms));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 1s);
    EXPECT_EQ(writer.wait_for(0ms), std::future_status::timeout);
    other.exec("ROLLBACK");
    writer.get();
}

}  // namespace
}  // namespace sheer::test::sqlite_store_test
