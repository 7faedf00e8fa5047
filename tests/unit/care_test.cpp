// The care of a SQLite archive: check, repair, garbage, copies, imports.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <future>
#include <random>

#include "server/archive/archive_copy.h"
#include "server/archive/sqlite_functions.h"
#include "server/storage/content_folder.h"
#include "store_fixture.h"

namespace sheer::test::care_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using Import = Care::Import;

std::vector<std::string> texts(const CheckResult& result, Finding::Kind kind = Finding::Kind::damage) {
    std::vector<std::string> all;
    for (const Finding& finding : result.findings)
        if (finding.kind == kind) all.push_back(finding.text);
    return all;
}

void make_old(const fs::path& file) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(2));
}

class CareTest : public WithSqlite {
  protected:
    Care& m_care = m_store.care();
    ContentFolder m_files{m_data.blobs()};

    fs::path blob(const std::string& bytes) const { return m_files.find(sha256_hex(bytes)).value(); }
    void change(const std::string& sql) {
        SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
        add_functions(database);
        database.exec("DROP TRIGGER reports_final; DROP TRIGGER documents_final");
        database.exec(sql);
        database.exec(
            "CREATE TRIGGER reports_final BEFORE UPDATE ON reports WHEN OLD.finished_ms IS NOT NULL\nBEGIN\n"
            "    SELECT RAISE(ABORT, 'a final report does not change');\nEND");
        database.exec(
            "CREATE TRIGGER documents_final BEFORE UPDATE ON documents\nBEGIN\n"
            "    SELECT RAISE(ABORT, 'a final report does not change');\nEND");
    }
};

TEST_F(CareTest, AnArchiveInUseIsWhole) {
    const std::string id = make_done("done", "picture");
    make_done("failed", "another");
    submit("queued");
    submit("running");
    lease();
    add_asset("upload");
    m_store.baselines().accept({"main", id, 0, "me", "why"});
    m_store.pins().pin({id, 0, "me", "why"});
    const CheckResult result = m_care.check(false);
    EXPECT_THAT(texts(result), testing::IsEmpty());
    EXPECT_THAT(texts(result, Finding::Kind::leftover), testing::IsEmpty());
    EXPECT_EQ(result.reports, 4);
    EXPECT_EQ(result.pictures, 2);
    EXPECT_EQ(result.uploads, 1);
    EXPECT_EQ(result.bytes, 7u + 7u + 6u);
}

TEST_F(CareTest, EveryRowIsComparedWithWhatItWas) {
    const std::string id = make_done("done", "picture");
    add_asset("upload");
    m_store.baselines().accept({"main", id, 0, "me", "why"});
    m_store.pins().pin({id, 0, "me", "why"});
    const auto found_after = [&](const std::string& sql, const std::string& undo) {
        change(sql);
        const std::vector<std::string> found = texts(m_care.check(false));
        change(undo);
        EXPECT_THAT(texts(m_care.check(false)), testing::IsEmpty()) << undo;
        return found;
    };
    EXPECT_THAT(found_after("UPDATE reports SET verdict = 'failed'", "UPDATE reports SET verdict = 'passed'"),
                testing::Contains(HasSubstr(id + ": its row was changed after it ended")));
    EXPECT_THAT(found_after("UPDATE reports SET spec = spec || ' '", "UPDATE reports SET spec = rtrim(spec)"),
                testing::Contains(HasSubstr("its spec has another hash")));
    EXPECT_THAT(found_after("UPDATE baselines SET reason = 'x'", "UPDATE baselines SET reason = 'why'"),
                testing::ElementsAre(HasSubstr("the acceptance of report " + id)));
    EXPECT_THAT(found_after("UPDATE pins SET reason = 'x'", "UPDATE pins SET reason = 'why'"),
                testing::ElementsAre(HasSubstr("the pin of report " + id)));
    EXPECT_THAT(found_after("UPDATE assets SET type = 'model'", "UPDATE assets SET type = 'texture'"),
                testing::ElementsAre(HasSubstr("the row of the upload")));
    EXPECT_THAT(found_after("UPDATE report_methods SET method = 'f2b'", "UPDATE report_methods SET method = 'b2f'"),
                testing::ElementsAre(HasSubstr("its methods are not those of its spec")));
    EXPECT_THAT(found_after("UPDATE blobs SET media_type = 'image/x'", "UPDATE blobs SET media_type = 'image/png'"),
                testing::ElementsAre(HasSubstr("its pictures are not those that its text names")));
    EXPECT_THAT(found_after("UPDATE search_lines SET words = ' other'", "UPDATE search_lines SET words = ' done'"),
                testing::Contains(HasSubstr("not in the index for searching")));
    EXPECT_THAT(found_after("UPDATE facets SET reports = 7 WHERE id = 3", "UPDATE facets SET reports = 1 WHERE id = 3"),
                testing::ElementsAre(HasSubstr("the count of the reports with status")));
    EXPECT_THAT(
        found_after("UPDATE search_blocks SET newest = newest + 1", "UPDATE search_blocks SET newest = newest - 1"),
        testing::ElementsAre(HasSubstr("the bits of the facets do not agree")));
    EXPECT_THAT(found_after("UPDATE facet_bits SET bits = sheer_with_bit(bits, 99, 1) WHERE facet = 3",
                            "UPDATE facet_bits SET bits = sheer_with_bit(bits, 99, 0) WHERE facet = 3"),
                testing::ElementsAre(HasSubstr("the bits of the facets do not agree")));
    EXPECT_THAT(found_after("CREATE TABLE stranger (x)", "DROP TABLE stranger"),
                testing::ElementsAre(HasSubstr("table stranger of the database is not ours")));
    EXPECT_THAT(found_after("UPDATE documents SET packed = cast(packed || x'00' AS BLOB)",
                            "UPDATE documents SET packed = cast(substr(packed, 1, length(packed) - 1) AS BLOB)"),
                testing::IsEmpty());
}

TEST_F(CareTest, FilesAreComparedWithTheirHashes) {
    make_done("one", "picture one");
    make_done("two", "picture two");
    make_done("three", "picture three");
    fs::resize_file(blob("picture one"), 5);
    fs::remove(blob("picture two"));
    const fs::path stray = m_data.blobs() / "ab" / "notes.txt";
    fs::create_directories(stray.parent_path());
    std::ofstream(stray) << "mine";
    make_old(stray);
    ContentFolder folder(m_data.blobs());
    folder.put(sha256_hex("orphan"), "orphan");
    make_old(blob("orphan"));
    const CheckResult result = m_care.check(false);
    EXPECT_THAT(texts(result),
                testing::UnorderedElementsAre(HasSubstr(sha256_hex("picture one") + " have another hash"),
                                              HasSubstr(sha256_hex("picture two") + " is missing")));
    EXPECT_THAT(texts(result, Finding::Kind::leftover),
                testing::UnorderedElementsAre(HasSubstr("blobs/ab/notes.txt"), HasSubstr(sha256_hex("orphan"))));
    EXPECT_TRUE(result.is_damaged());
}

TEST_F(CareTest, ARepairMovesAndDeletesNothing) {
    const std::string whole = make_done("whole", "kept"), cut = make_done("cut", "cut picture");
    const std::string broken = make_done("broken", "picture of broken");
    m_store.pins().pin({broken, 0, "me", "why"});
    fs::resize_file(blob("cut picture"), 3);
    change("UPDATE documents SET packed = substr(packed, 1, 20) WHERE report_id = '" + broken + "'");
    change("DELETE FROM report_facets WHERE place = (SELECT place FROM search_lines WHERE report_id = '" + whole +
           "')");
    const CheckResult after = m_care.check(true);
    EXPECT_THAT(texts(after), testing::ElementsAre(HasSubstr(sha256_hex("cut picture") + " is missing")));
    EXPECT_THAT(after.repairs, testing::UnorderedElementsAre(HasSubstr("moved to quarantine/"), HasSubstr(broken),
                                                             HasSubstr("index for searching is made again")));
    EXPECT_FALSE(m_reports.find(broken));
    EXPECT_EQ(m_reports.list({.methods = {"b2f"}}).count, 2);
    // The rows, and the files as they were.
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(m_data.quarantine())) {
        if (!entry.is_regular_file()) continue;
        ++files;
        if (entry.path().filename() == broken + ".json") {
            std::ifstream stream(entry.path());
            const json rows = json::parse(stream);
            EXPECT_EQ(rows["reports"][0]["title"], "broken");
            EXPECT_EQ(rows["pins"][0]["reason"], "why");
            EXPECT_EQ(rows["documents"][0]["packed"]["hex"].get<std::string>().size(), 40u);
        } else {
            EXPECT_EQ(fs::file_size(entry.path()), 3u);
        }
    }
    EXPECT_EQ(files, 2);
    EXPECT_EQ(picture(sha256_hex("picture of broken")), "picture of broken");
    // Rendering the same picture again makes the archive whole.
    make_done("again", "cut picture");
    EXPECT_THAT(texts(m_care.check(false)), testing::IsEmpty());
    EXPECT_EQ(cut.size(), 36u);
}

TEST_F(CareTest, GarbageIsCollectedBesideCommits) {
    ContentFolder folder(m_data.blobs()), uploads(m_data.assets());
    for (int i = 0; i < 250; ++i) folder.put(sha256_hex(std::to_string(i)), std::to_string(i));
    uploads.put(sha256_hex("upload"), "upload");
    const std::string id = make_done("title", "picture");
    // While reports with the same pictures are committed by another process.
    const auto other = m_place->open(m_rules, m_clock);
    std::vector<std::string> ids;
    for (int i = 0; i < 20; ++i) ids.push_back(submit("job " + std::to_string(i)));
    for (int i = 0; i < 20; ++i) m_pictures[sha256_hex(std::to_string(i))] = std::to_string(i);
    auto commits = std::async(std::launch::async, [&] {
        for (int i = 0; i < 20; ++i) {
            const auto job = other->queue().lease("other");
            EXPECT_TRUE(other->queue().commit(*job, finished(*job, std::to_string(i))));
        }
    });
    std::int64_t removed = 0;
    for (int round = 0; round < 5; ++round) removed += m_care.collect_garbage().files;
    commits.get();
    removed += m_care.collect_garbage().files;
    EXPECT_GE(removed, 231);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(picture(sha256_hex(std::to_string(i))), std::to_string(i));
    EXPECT_EQ(TemporaryFolder::count_files(m_data.blobs()), 21);
    EXPECT_EQ(TemporaryFolder::count_files(m_data.assets()), 0);
    EXPECT_THAT(texts(m_care.check(false)), testing::IsEmpty());
    EXPECT_TRUE(m_reports.find(id));
}

TEST_F(CareTest, ABackupDuringRunningJobsHoldsWhatWasFinishedBefore) {
    std::vector<std::string> before;
    for (int i = 0; i < 10; ++i)
        before.push_back(make_done("before " + std::to_string(i), "picture " + std::to_string(i)));
    add_asset("upload");
    for (int i = 0; i < 50; ++i) submit("job " + std::to_string(i));
    std::vector<Lease> running;
    for (int i = 0; i < 50; ++i) running.push_back(lease());
    const auto other = m_place->open(m_rules, m_clock);
    std::atomic<bool> begun = false;
    auto commits = std::async(std::launch::async, [&] {
        for (const Lease& job : running) {
            EXPECT_TRUE(other->queue().commit(job, finished(job, "of " + job.id)));
            begun = true;
        }
        // One that the backup may or may not have.
        EXPECT_EQ(other->reports().remove(running.front().id), ReportArchive::Removal::deleted);
    });
    while (!begun) std::this_thread::yield();
    std::vector<std::string> finished_before = before;
    for (const ReportSummary& each : m_reports.list({.status = Status::done, .limit = 100}).reports)
        if (each.id != running.front().id) finished_before.push_back(each.id);
    const BackupResult result = m_care.back_up(m_folder.path() / "backup");
    commits.get();
    EXPECT_THAT(result.damaged, testing::IsEmpty());
    EXPECT_EQ(result.uploads, 1);
    const DataFolder restored{m_folder.path() / "restored"};
    copy_archive({m_folder.path() / "backup"}, restored);
    SqliteStore store(restored.root, m_rules, m_clock);
    const CheckResult check = store.care().check(false);
    EXPECT_THAT(texts(check), testing::IsEmpty());
    EXPECT_THAT(texts(check, Finding::Kind::leftover), testing::IsEmpty());
    for (const std::string& id : finished_before) {
        const auto there = store.reports().find(id);
        ASSERT_TRUE(there) << id;
        EXPECT_EQ(there->report, m_reports.find(id)->report);
    }
    EXPECT_THROW(copy_archive(m_data, restored), StoreError);
    EXPECT_THROW(copy_archive({m_folder.path() / "nothing"}, {m_folder.path() / "new"}), StoreError);
    EXPECT_FALSE(fs::exists(m_folder.path() / "nothing"));
}

TEST_F(CareTest, ABackupSaysWhatIsDamaged) {
    make_done("title", "picture");
    make_done("whole", "another");
    fs::resize_file(blob("picture"), 1);
    const BackupResult result = m_care.back_up(m_folder.path() / "backup");
    EXPECT_THAT(result.damaged, testing::ElementsAre(HasSubstr(sha256_hex("picture"))));
    EXPECT_EQ(result.reports, 2);
    EXPECT_EQ(result.pictures, 1);
}

TEST_F(CareTest, AReportIsImportedOnce) {
    const std::string id = make_done("moved", "picture");
    const auto record = m_reports.find(id).value();
    ImportedReport imported{.id = id, .created_ms = record.created_ms, .spec = record.spec};
    imported.spec_sha256 = record.spec_sha256;
    imported.finished.report = json::parse(record.report);
    imported.finished.finished_ms = *record.finished_ms;
    add_picture(imported.finished, "picture");
    const TemporaryFolder folder;
    SqliteStore other(folder.path() / "data", m_rules, m_clock);
    EXPECT_EQ(other.care().import_report(imported), Import::added);
    const auto there = other.reports().find(id);
    ASSERT_TRUE(there);
    EXPECT_EQ(there->report, record.report);
    EXPECT_EQ(there->created_ms, record.created_ms);
    EXPECT_EQ(there->finished_ms, record.finished_ms);
    EXPECT_EQ(other.reports().list({.q = "moved", .methods = {"b2f"}, .status = Status::done}).count, 1);
    EXPECT_EQ(other.reports().list({.status = Status::queued}).count, 0);
    EXPECT_THAT(texts(other.care().check(false)), testing::IsEmpty());
    EXPECT_EQ(other.care().import_report(imported), Import::known);
    const DataFolder data{folder.path() / "data"};
    fs::remove(ContentFolder(data.blobs()).find(sha256_hex("picture")).value());
    EXPECT_EQ(other.care().import_report(imported), Import::restored);
    EXPECT_THAT(texts(other.care().check(false)), testing::IsEmpty());
    imported.finished.report["verdict"] = "failed";
    add_picture(imported.finished, "new one");
    EXPECT_EQ(other.care().import_report(imported), Import::differs);
    EXPECT_EQ(TemporaryFolder::count_files(data.blobs()), 1);
    EXPECT_EQ(other.reports().find(id)->report, record.report);
}

TEST_F(CareTest, AReportsBytesAreThoseThatNoNewerOneNames) {
    const std::string old = make_done("old", "shared picture");
    const std::string young = make_done("young", "shared picture");
    submit("queued");
    m_store.pins().pin({old, 0, "", ""});
    const auto reports = m_care.stored_reports();
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0].id, young);
    EXPECT_FALSE(reports[0].is_kept);
    EXPECT_TRUE(reports[1].is_kept);
    // The texts have nearly the same size.
    EXPECT_NEAR(static_cast<double>(reports[0].bytes - reports[1].bytes), 14 + 2, 8);
    const StoreSize size = m_care.size();
    EXPECT_EQ(size.reports, 2);
    EXPECT_EQ(size.pictures, 1);
    EXPECT_EQ(size.picture_bytes, 14u);
}

}  // namespace
}  // namespace sheer::test::care_test
