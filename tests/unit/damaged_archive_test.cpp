// A damaged archive: losses are reported, and the rest is available.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <fstream>

#include "server/archive/sqlite_open.h"
#include "server/http/application.h"
#include "server/http/service.h"
#include "server/storage/content_folder.h"
#include "store_fixture.h"

namespace sheer::test::damaged_archive_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

void flip_bit(const fs::path& file, std::size_t at) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const char byte = static_cast<char>(stream.get() ^ 1);
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(byte);
}

class DamagedFilesTest : public WithSqlite {
  protected:
    DamagedFilesTest() { m_service.clock = m_clock; }

    http::Response get(const std::string& target) {
        http::Request request{.method = "GET", .target = target, .headers = {}, .body = {}, .path_values = {}};
        request.headers.add("Host", "localhost");
        return std::get<http::Response>(m_application.answer(std::move(request)));
    }

    static std::string detail(const http::Response& response) {
        return json::parse(std::get<std::string>(response.body))["detail"];
    }

    static fs::path file_in(const fs::path& folder, const std::string& bytes) {
        return ContentFolder(folder).find(sha256_hex(bytes)).value();
    }
    fs::path blob(const std::string& bytes) const { return file_in(m_data.blobs(), bytes); }

    http::Service m_service{.store = m_store, .ids = m_ids, .clock = {}, .list_devices = {}};
    const http::Application m_application{http::make_guard(true, {}), http::make_router(m_service)};
};

TEST_F(DamagedFilesTest, APictureWithOtherBytesIsNotServed) {
    const std::string id = make_done("title", "the picture"), sha256 = sha256_hex("the picture");
    const std::string url = "/api/v1/blobs/" + sha256;
    EXPECT_EQ(get(url).status, 200);
    flip_bit(blob("the picture"), 3);
    for (const std::string& path : {url, "/api/v1/reports/" + id + "/report.html"}) {
        const http::Response damaged = get(path);
        EXPECT_EQ(damaged.status, 500) << path;
        EXPECT_EQ(damaged.headers.find("Content-Type"), "application/problem+json");
        EXPECT_EQ(damaged.headers.find("Cache-Control"), "no-store");
        EXPECT_FALSE(damaged.headers.contains("ETag"));
        EXPECT_THAT(detail(damaged), HasSubstr(sha256));
    }
    EXPECT_THROW(m_blobs.open(sha256), DamagedData);
    // The time of a file says nothing about its bytes.
    flip_bit(blob("the picture"), 3);
    EXPECT_EQ(get(url).status, 200);
}

TEST_F(DamagedFilesTest, ATruncatedOrMissingPictureIsNotServed) {
    make_done("title", "the picture");
    const std::string url = "/api/v1/blobs/" + sha256_hex("the picture");
    fs::resize_file(blob("the picture"), 4);
    EXPECT_EQ(get(url).status, 500);
    fs::remove(blob("the picture"));
    EXPECT_EQ(get(url).status, 500);
    EXPECT_THAT(detail(get(url)), HasSubstr("missing"));
    EXPECT_THAT(detail(get(url)), testing::Not(HasSubstr(m_folder.path().string())));
}

TEST_F(DamagedFilesTest, StoringTheSamePictureAgainRepairsIt) {
    make_done("first", "the picture");
    const std::string url = "/api/v1/blobs/" + sha256_hex("the picture");
    flip_bit(blob("the picture"), 0);
    make_done("second", "the picture");
    EXPECT_EQ(get(url).status, 200);
    fs::remove(blob("the picture"));
    make_done("third", "the picture");
    EXPECT_EQ(get(url).status, 200);
}

TEST_F(DamagedFilesTest, UploadsAreComparedWithTheirHashesToo) {
    const std::string bytes = "pixels", sha256 = sha256_hex(bytes), url = "/api/v1/assets/" + sha256;
    Asset asset{.sha256 = sha256, .type = "texture", .media_type = "image/png"};
    asset.facts = json::object();
    m_assets.add(asset, bytes);
    const fs::path file = file_in(m_data.assets(), bytes);
    flip_bit(file, 2);
    EXPECT_EQ(get(url).status, 500);
    m_assets.add(asset, bytes);
    EXPECT_EQ(get(url).status, 200);
    fs::remove(file);
    EXPECT_EQ(get(url).status, 500);
    const http::Response list = get("/api/v1/assets");
    EXPECT_EQ(list.status, 200);
    EXPECT_THAT(json::parse(std::get<std::string>(list.body))["assets"][0]["broken"], "its file is missing");
    EXPECT_EQ(m_assets.remove(sha256), Assets::Removal::removed);
}

TEST_F(DamagedFilesTest, ABrokenRowLeavesTheRestOfTheList) {
    make_done("broken", "a");
    make_done("whole", "b");
    Asset asset{.sha256 = sha256_hex("c"), .type = "texture", .media_type = "image/png"};
    asset.facts = json::object();
    m_assets.add(asset, "c");
    SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TRIGGER reports_final");
    database.exec("UPDATE reports SET preview = '{\"sha' WHERE title = 'broken'");
    database.exec(
        "DROP TRIGGER documents_final; UPDATE documents SET packed = substr(packed, 1, 20) "
        "WHERE report_id = (SELECT id FROM reports WHERE title = 'broken')");
    database.exec("UPDATE assets SET facts = '[1'");
    const http::Response list = get("/api/v1/reports");
    ASSERT_EQ(list.status, 200);
    const json reports = json::parse(std::get<std::string>(list.body))["reports"];
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_FALSE(reports[0].contains("broken"));
    EXPECT_TRUE(reports[0]["preview"].is_object());
    EXPECT_TRUE(reports[1]["preview"].is_null());
    EXPECT_EQ(reports[1]["broken"], "its preview cannot be read");
    const std::string path = "/api/v1/reports/" + reports[1]["id"].get<std::string>();
    EXPECT_EQ(get(path + "/report.html").status, 500);
    EXPECT_EQ(get(path + "/diff?against=" + reports[0]["id"].get<std::string>()).status, 500);
    ASSERT_EQ(get("/api/v1/assets").status, 200);
}

TEST_F(DamagedFilesTest, ABrokenReportIsNamedWithItsError) {
    const std::string whole = make_done("whole", "a");
    submit("damaged");
    const Lease job = lease();
    FinishedReport damaged = finished(job, "b");
    damaged.report["runs"][0]["results"] = 3;
    ASSERT_TRUE(m_queue.commit(job, damaged));
    for (const std::string& end :
         {std::string("/report.html"), "/diff?against=" + whole, std::string("/pixel?x=0&y=0")}) {
        const http::Response answer = get("/api/v1/reports/" + job.id + end);
        EXPECT_EQ(answer.status, 500) << end;
        EXPECT_THAT(detail(answer), HasSubstr(job.id + ": /runs/0/results must be an array, not 3"));
    }
}

/// Folders in which a store can or cannot be opened.
class OpeningTest : public testing::Test {
  protected:
    SqliteStore open() { return SqliteStore(m_data, {}, system_now_ms); }

    std::string refusal() {
        try {
            open();
        } catch (const StoreError& error) {
            return error.what();
        }
        return "";
    }

    /// A database with a report and a picture.
    void fill() {
        SqliteStore store = open();
        NewReport report{
            .id = "01900000-0000-7000-8000-000000000000", .spec = R"({"title": "kept"})", .spec_sha256 = "x"};
        store.queue().submit(report, {10});
        const FinishedReport finished{.report = {{"verdict", "none"}},
                                      .blobs = {{sha256_hex("picture"), "image/png"}},
                                      .read_blob = [](const std::string&) { return "picture"; }};
        ASSERT_TRUE(store.queue().commit(store.queue().lease("worker").value(), finished));
    }

    TemporaryFolder m_folder;
    const fs::path m_data = m_folder.path() / "data", m_file = m_data / "archive.sqlite";
};

TEST_F(OpeningTest, AMissingDatabaseBesideItsPicturesIsAnError) {
    fill();
    fs::remove(m_file);
    EXPECT_THAT(refusal(), testing::AllOf(HasSubstr(m_file.string()), HasSubstr("missing")));
    EXPECT_FALSE(fs::exists(m_file));
    std::ofstream(m_file).close();
    EXPECT_THAT(refusal(), testing::AllOf(HasSubstr(m_file.string()), HasSubstr("empty")));
    // With nothing beside it, a new archive can begin here.
    fs::remove_all(m_data / "blobs");
    EXPECT_EQ(refusal(), "");
}

TEST_F(OpeningTest, ATruncatedDatabaseIsAnError) {
    fill();
    const std::uintmax_t size = fs::file_size(m_file);
    for (const std::uintmax_t left : {size - 4096, size / 2, std::uintmax_t{4096}, std::uintmax_t{50}}) {
        fs::resize_file(m_file, left);
        EXPECT_THAT(refusal(), HasSubstr(m_file.string())) << left;
    }
}

TEST_F(OpeningTest, ADamagedDatabaseIsAnError) {
    fill();
    // The second page, of a table or an index.
    std::fstream stream(m_file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(4096);
    stream << std::string(300, '\xa5');
    stream.close();
    EXPECT_THAT(refusal(), testing::AllOf(HasSubstr(m_file.string()), HasSubstr("damaged")));
    fs::resize_file(m_file, 0);
    std::ofstream(m_file) << std::string(5000, 'x');
    EXPECT_THAT(refusal(), HasSubstr("not a SQLite database"));
}

TEST_F(OpeningTest, ADatabaseOfAnotherProgramIsLeftAlone) {
    fs::create_directories(m_data);
    {
        SQLite::Database other(m_file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        other.exec("CREATE TABLE reports (id TEXT); INSERT INTO reports VALUES ('mine')");
    }
    EXPECT_THAT(refusal(), HasSubstr("another program"));
    {
        SQLite::Database other(m_file.string(), SQLite::OPEN_READWRITE);
        EXPECT_EQ(other.execAndGet("PRAGMA journal_mode").getString(), "delete");
        EXPECT_EQ(other.execAndGet("SELECT count(*) FROM sqlite_schema").getInt(), 1);
        other.exec("DROP TABLE reports; PRAGMA application_id = 7");
    }
    EXPECT_THAT(refusal(), HasSubstr("another program"));
}

TEST_F(OpeningTest, OursIsRecognizedByItsIdAndAnOlderOneByItsTables) {
    fill();
    {
        SQLite::Database database(m_file.string(), SQLite::OPEN_READWRITE);
        EXPECT_EQ(database.execAndGet("PRAGMA application_id").getInt(), archive_application_id);
        database.exec("PRAGMA application_id = 0");
    }
    EXPECT_EQ(open().reports().list({}).reports.at(0).title, "kept");
    SQLite::Database database(m_file.string(), SQLite::OPEN_READWRITE);
    EXPECT_EQ(database.execAndGet("PRAGMA application_id").getInt(), archive_application_id);
    database.exec("PRAGMA user_version = 99");
    EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("version 99"), HasSubstr(m_data.string())));
}

TEST_F(OpeningTest, ACopyOfTheDatabaseOfAnIdleStoreHasAllReports) {
    SqliteStore store = open();
    NewReport report{.id = "01900000-0000-7000-8000-000000000000", .spec = R"({"title": "kept"})", .spec_sha256 = "x"};
    store.queue().submit(report, {10});
    const FinishedReport finished{.report = {{"verdict", "none"}}};
    ASSERT_TRUE(store.queue().commit(store.queue().lease("worker").value(), finished));
    fs::create_directories(m_folder.path() / "copy");
    fs::copy_file(m_file, m_folder.path() / "copy/archive.sqlite");
    SqliteStore copy(m_folder.path() / "copy", {}, system_now_ms);
    ASSERT_EQ(copy.reports().list({}).reports.size(), 1u);
    EXPECT_EQ(copy.reports().list({}).reports[0].status, Status::done);
}

}  // namespace
}  // namespace sheer::test::damaged_archive_test
