// Properties of only the SQLite store.
#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <future>

#include "embedded_server_files.h"
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
    EXPECT_THROW(database.exec("UPDATE documents SET packed = x'00'"), SQLite::Exception);
    EXPECT_EQ(json::parse(m_reports.find(id)->report)["verdict"], "passed");
}

TEST_F(SqliteStoreTest, ATextOfAnotherReportIsNotServed) {
    const std::string one = make_done("one", "a"), two = make_done("two", "b");
    EXPECT_TRUE(m_reports.find(one));
    SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TRIGGER documents_final");
    const auto move = [&](const std::string& from, const std::string& to) {
        EXPECT_EQ(database.exec("UPDATE documents SET report_id = '" + to + "' WHERE report_id = '" + from + "'"), 1);
    };
    move(one, "kept");
    move(two, one);
    move("kept", two);
    EXPECT_THROW(m_reports.find(one), DamagedData);
    EXPECT_THROW(m_reports.find(two), DamagedData);
}

/// The last process that closes the database deletes its log. It knows of the others by their locks on the file, which
/// a process loses if it opens and closes that file itself.
TEST_F(SqliteStoreTest, AnotherProcessThatEndsLeavesTheLog) {
    submit("before");
    const auto log = m_data.database().string() + "-wal";
    ASSERT_TRUE(std::filesystem::exists(log));
    const std::string other =
        "sqlite3 " + m_data.database().string() + " 'SELECT count(*) FROM sqlite_schema' > /dev/null";
    EXPECT_EQ(m_reports.list({}).reports.size(), 1u);  // opens a reader
    ASSERT_EQ(std::system(other.c_str()), 0);
    EXPECT_TRUE(std::filesystem::exists(log));
    submit("after");
    SQLite::Database database(m_data.database().string(), SQLite::OPEN_READONLY);
    EXPECT_EQ(database.execAndGet("SELECT count(*) FROM reports").getInt(), 2);
    EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
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

/// An archive of the version that the first `version` migrations make, with a done, a failed and a queued report.
void make_old_archive(const std::filesystem::path& folder, int version) {
    constexpr std::array files = {"schema.sql", "assets.sql", "retries.sql", "baselines.sql"};
    std::filesystem::create_directories(folder);
    SQLite::Database database((folder / "archive.sqlite").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    for (int i = 0; i < version; ++i)
        for (const EmbeddedFile& file : embedded_server_files())
            if (file.path == files[static_cast<std::size_t>(i)]) database.exec(std::string(file.bytes));
    database.exec("PRAGMA user_version = " + std::to_string(version));
    const std::string insert =
        "INSERT INTO reports (id, status, created_ms, finished_ms, title, scene, spec_sha256, verdict, error_title, "
        "error_detail, spec, report) VALUES ";
    database.exec(insert + R"(('01900000-0000-7000-8000-000000000001', 'done', 1, 2, 'old one', 'quads', 'hash',
        'passed', NULL, NULL, '{"title": "old one", "scene": {"type": "quads"}, "methods": [{"id": "b2f"}],
        "tags": {"branch": "main"}}', '{"id": "old", "verdict": "passed", "device": {"renderer": "Renderer X"}}'))");
    database.exec(insert + R"(('01900000-0000-7000-8000-000000000002', 'failed', 1, 2, 'no', 'quads', 'hash',
        NULL, 'title', 'detail', '{"title": "no"}', NULL))");
    database.exec(insert + R"(('01900000-0000-7000-8000-000000000003', 'queued', 1, NULL, 'next', 'quads', 'hash',
        NULL, NULL, NULL, '{"title": "next"}', NULL))");
    database.exec(
        "INSERT INTO report_methods VALUES ('01900000-0000-7000-8000-000000000001', 0, 'b2f');"
        "INSERT INTO report_tags VALUES ('01900000-0000-7000-8000-000000000001', 'branch', 'main')");
}

class OldArchiveTest : public testing::TestWithParam<int> {};

TEST_P(OldArchiveTest, IsBroughtUpToDate) {
    const TemporaryFolder folder;
    make_old_archive(folder.path(), GetParam());
    SqliteStore store(folder.path(), {}, system_now_ms);
    const std::string done = "01900000-0000-7000-8000-000000000001";
    const auto record = store.reports().find(done);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->status, Status::done);
    EXPECT_EQ(record->report, R"({"id": "old", "verdict": "passed", "device": {"renderer": "Renderer X"}})");
    EXPECT_EQ(store.reports().find("01900000-0000-7000-8000-000000000002")->error->detail, "detail");
    EXPECT_EQ(store.reports().list({}).count, 3);
    EXPECT_EQ(
        store.reports()
            .list({.q = "old", .tags = {"branch:main"}, .methods = {"b2f"}, .device = "renderer", .verdict = "passed"})
            .reports.at(0)
            .id,
        done);
    EXPECT_TRUE(store.assets().list(1).empty());
    EXPECT_EQ(store.baselines().accept({"main", done, 0, "", ""}), Baselines::Acceptance::added);
    EXPECT_EQ(store.queue().lease("worker")->id, "01900000-0000-7000-8000-000000000003");
}

INSTANTIATE_TEST_SUITE_P(EveryVersion, OldArchiveTest, testing::Range(1, 5));

TEST_F(SqliteStoreTest, AJobOfTheVersionBeforePartsKeepsItsWish) {
    const std::string wish = submit("on a GPU", {{"device", "nvidia"}}), any = submit("anywhere");
    {
        SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
        database.exec("DROP TRIGGER parts_over; DROP TABLE parts");
        for (const char* column : {"labels", "parts", "parts_ended", "part"})
            database.exec(std::string("ALTER TABLE jobs DROP COLUMN ") + column);
        database.exec("PRAGMA user_version = 12");
    }
    SqliteStore store(m_data.root, m_rules, m_clock);
    EXPECT_EQ(store.queue().lease("a", "intel")->id, any);
    EXPECT_FALSE(store.queue().lease("b", "intel"));
    EXPECT_EQ(store.queue().lease("c", "nvidia")->id, wish);
    EXPECT_TRUE(store.care().check(false).findings.empty());
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
