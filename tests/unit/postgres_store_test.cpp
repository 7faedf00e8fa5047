// Properties of only the PostgreSQL store. Without a server (tests/private_postgres.sh) there are no such tests.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <poll.h>

#include <atomic>
#include <future>
#include <set>
#include <thread>

#include "server/postgres/migrate.h"
#include "server/storage/content_folder.h"
#include "store_fixture.h"

namespace sheer::test::postgres_store_test {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class PostgresStoreTest : public StoreTest {
  protected:
    PostgresPlace& place() { return dynamic_cast<PostgresPlace&>(*m_place); }
    /// With the database's clock.
    std::unique_ptr<Store> open() { return std::make_unique<PostgresStore>(place().url(), m_data.root, m_rules); }

    void end_connections() {
        place().run(
            "DO $$ BEGIN PERFORM pg_terminate_backend(pid, 5000) FROM pg_stat_activity WHERE datname = "
            "current_database() AND pid <> pg_backend_pid(); END $$");
    }

    std::string refusal() {
        try {
            open();
        } catch (const StoreError& error) {
            return error.what();
        }
        return "";
    }

    /// Of the store's check.
    std::vector<std::string> findings() {
        std::vector<std::string> all;
        for (const Finding& finding : m_store.care().check(false).findings) all.push_back(finding.text);
        return all;
    }

    /// Changes what the database keeps from being changed.
    void damage(const std::string& sql) {
        place().run("SET session_replication_role = replica; SET search_path TO sheer, pg_catalog; " + sql);
    }
};

TEST_P(PostgresStoreTest, ALostConnectionIsReplaced) {
    const std::string id = submit("before");
    end_connections();
    EXPECT_EQ(status(id), Status::queued);
    end_connections();
    EXPECT_EQ(lease().id, id);
    end_connections();
    EXPECT_EQ(m_reports.remove(id), ReportArchive::Removal::cancelling);
    EXPECT_EQ(m_reports.list({}).count, 1);
}

TEST_P(PostgresStoreTest, AWatchThatLostItsConnectionReportsAChange) {
    const auto watch = m_store.watch();
    EXPECT_GE(watch->descriptor(), 0);
    end_connections();
    EXPECT_THROW(watch->wait(5s), StoreUnreachable);
    EXPECT_EQ(watch->descriptor(), -1);
    submit("in between");
    EXPECT_TRUE(watch->wait(5s)) << "something may have been missed";
    EXPECT_FALSE(watch->wait(10ms));
    submit("after");
    EXPECT_TRUE(watch->wait(5s));
}

TEST_P(PostgresStoreTest, WorkersAreToldOfJobsOnly) {
    const auto watch = m_store.watch_jobs();
    const auto is_told = [&] {
        pollfd readable{.fd = watch->descriptor(), .events = POLLIN, .revents = 0};
        poll(&readable, 1, 200);
        return watch->wait(0ms);
    };
    submit("new");
    EXPECT_TRUE(is_told());
    const Lease job = lease();
    m_queue.heartbeat(job, 0.5, "timing");
    EXPECT_FALSE(is_told());
    m_queue.release(job);
    EXPECT_TRUE(is_told());
}

TEST_P(PostgresStoreTest, NoMessageHasThePassword) {
    for (const char* url : {"postgresql://me:hunter2secret@127.0.0.1:1/x", "postgresql://me:hunter2%zz@host/x",
                            "postgresql://me:hunter2secret@host:port/x", "postgresql://host/x?hunter2secret",
                            "postgresql://127.0.0.1:1/x?password=hunter2secret", "mysql://me:hunter2secret@host/x",
                            "postgresql://me:hunter2secret@[::1/x"}) {
        try {
            PostgresStore(url, m_data.root, m_rules);
            ADD_FAILURE() << url;
        } catch (const StoreError& error) {
            EXPECT_THAT(error.what(), Not(HasSubstr("hunter2"))) << url;
        }
    }
    EXPECT_EQ(postgres::Address("postgresql://me:a b@host/x").without_password("no a b, says\nhost\n"),
              "no ***, says; host");
}

TEST_P(PostgresStoreTest, AStoreOfANewerVersionIsRefused) {
    place().run(fmt::format("UPDATE sheer.store SET version = {}", postgres::schema_version() + 1));
    EXPECT_THAT(refusal(), HasSubstr(fmt::format("has version {}, but this program knows only version {}",
                                                 postgres::schema_version() + 1, postgres::schema_version())));
}

TEST_P(PostgresStoreTest, AJobOfTheVersionBeforePartsKeepsItsWish) {
    const std::string wish = submit("on a GPU", {{"device", "nvidia"}}), any = submit("anywhere");
    place().run(
        "DROP TABLE sheer.parts; ALTER TABLE sheer.jobs DROP COLUMN labels, DROP COLUMN parts, DROP COLUMN "
        "parts_ended, DROP COLUMN part, ADD COLUMN label text NOT NULL DEFAULT ''");
    place().run("UPDATE sheer.jobs SET label = 'nvidia' WHERE report_id = '" + wish + "'");
    place().run("UPDATE sheer.store SET version = 2");
    const auto store = m_place->open(m_rules, m_clock);
    EXPECT_EQ(store->queue().lease("a", "intel")->id, any);
    EXPECT_FALSE(store->queue().lease("b", "intel"));
    EXPECT_EQ(store->queue().lease("c", "nvidia")->id, wish);
}

TEST_P(PostgresStoreTest, ASchemaOfAnotherProgramIsRefused) {
    place().run("DROP SCHEMA sheer CASCADE; CREATE SCHEMA sheer; CREATE TABLE sheer.reports (id text)");
    EXPECT_THAT(refusal(), HasSubstr("of another program"));
    place().run("CREATE TABLE sheer.store (x text)");
    EXPECT_THAT(refusal(), HasSubstr("of another program"));
    place().run("DROP SCHEMA sheer CASCADE; CREATE SCHEMA sheer; CREATE TABLE public.reports (id text)");
    EXPECT_EQ(refusal(), "") << "an empty schema may be made by an administrator; others have other names";
    place().run("DROP TABLE public.reports");
}

TEST_P(PostgresStoreTest, ManyProcessesMayMakeItAtOnce) {
    place().run("DROP SCHEMA sheer CASCADE");
    std::vector<std::future<std::string>> all;
    for (int i = 0; i < 6; ++i) all.push_back(std::async(std::launch::async, [this] { return refusal(); }));
    for (auto& each : all) EXPECT_EQ(each.get(), "");
}

TEST_P(PostgresStoreTest, TheDatabasesClockDecides) {
    const auto store = open();
    const NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = sha256_hex("{}")};
    store->queue().submit(report, {10});
    const std::int64_t created_ms = store->reports().find(report.id)->created_ms;
    EXPECT_LT(std::abs(created_ms - system_now_ms()), 60'000);
    EXPECT_TRUE(store->queue().lease("worker"));
    EXPECT_FALSE(store->queue().lease("worker")) << "the lease has not expired";
}

TEST_P(PostgresStoreTest, ManyWorkersGetEachJobOnce) {
    constexpr int jobs = 90, workers = 6;
    std::set<std::string> ids;
    for (int i = 0; i < jobs; ++i) ids.insert(submit(fmt::format("job {}", i), {{"tags", {{"n", "x"}}}}));
    std::vector<std::future<std::vector<std::string>>> all;
    for (int i = 0; i < workers; ++i)
        all.push_back(std::async(std::launch::async, [&, i] {
            const auto store = open();
            std::vector<std::string> done;
            while (const auto job = store->queue().lease(fmt::format("worker {}", i))) {
                FinishedReport report{.report = {{"id", job->id}, {"status", "done"}}, .finished_ms = 1};
                report.blobs = {{sha256_hex("shared"), "image/png"}};
                report.read_blob = [](const std::string&) { return "shared"; };
                if (store->queue().commit(*job, report)) done.push_back(job->id);
            }
            return done;
        }));
    std::vector<std::string> done;
    for (auto& each : all)
        for (std::string& id : each.get()) done.push_back(std::move(id));
    EXPECT_EQ(done.size(), ids.size());
    EXPECT_EQ(std::set<std::string>(done.begin(), done.end()), ids);
    EXPECT_EQ(m_reports.list({.status = Status::done}).count, jobs);
}

TEST_P(PostgresStoreTest, ADeletionTakesNoPictureFromACommit) {
    std::atomic<bool> over = false;
    std::thread deleting([&] {
        const auto store = open();
        while (!over)
            for (const ReportSummary& each : store->reports().list({.status = Status::done}).reports)
                store->reports().remove(each.id);
    });
    for (int i = 0; i < 100; ++i) make_done("one of many", "the picture of all");
    over = true;
    deleting.join();
    const std::string kept = make_done("kept", "the picture of all");
    EXPECT_EQ(picture(sha256_hex("the picture of all")), "the picture of all");
    EXPECT_EQ(status(kept), Status::done);
    EXPECT_THAT(findings(), IsEmpty());
}

TEST_P(PostgresStoreTest, AFinalReportDoesNotChange) {
    make_done("done", "picture");
    EXPECT_THROW(place().run("UPDATE sheer.reports SET verdict = 'failed'"), StoreError);
    EXPECT_THROW(place().run("UPDATE sheer.documents SET packed = ''"), StoreError);
}

TEST_P(PostgresStoreTest, WhatIsDamagedIsFound) {
    const std::string id = make_done("done", "picture");
    submit("queued", {{"tags", {{"branch", "main"}}}});
    add_asset("upload");
    EXPECT_THAT(findings(), IsEmpty());
    const auto found_after = [&](const std::string& sql, const std::string& undo) {
        damage(sql);
        const auto found = findings();
        damage(undo);
        EXPECT_THAT(findings(), IsEmpty()) << undo;
        return found;
    };
    EXPECT_THAT(found_after("UPDATE blobs SET bytes = 'pictureX'", "UPDATE blobs SET bytes = 'picture'"),
                ElementsAre(HasSubstr("the picture " + sha256_hex("picture") + " have another hash")));
    EXPECT_THAT(found_after("UPDATE assets SET bytes = 'other'", "UPDATE assets SET bytes = 'upload'"),
                ElementsAre(HasSubstr("the upload " + sha256_hex("upload"))));
    EXPECT_THAT(found_after("UPDATE documents SET packed = packed || '\\x00'::bytea, sha256 = 'x' || sha256",
                            "UPDATE documents SET sha256 = substr(sha256, 2)"),
                ElementsAre(HasSubstr(id + " cannot be read: the text of report")));
    EXPECT_THAT(found_after("UPDATE reports SET spec = spec || ' '", "UPDATE reports SET spec = rtrim(spec)"),
                Contains(HasSubstr("its spec has another hash")));
    EXPECT_THAT(found_after("UPDATE reports SET verdict = 'failed' WHERE status = 'done'",
                            "UPDATE reports SET verdict = 'passed' WHERE status = 'done'"),
                ElementsAre(HasSubstr("not in the index")));
    EXPECT_THAT(found_after("UPDATE reports SET tags = '{}' WHERE status IS NULL",
                            "UPDATE reports SET tags = '{\"branch\":\"main\"}' WHERE status IS NULL"),
                ElementsAre(HasSubstr("its tags are not those of its spec")));
    EXPECT_THAT(found_after("UPDATE reports SET methods = '{f2b}' WHERE status = 'done'",
                            "UPDATE reports SET methods = '{b2f}' WHERE status = 'done'"),
                ElementsAre(HasSubstr("its methods are not those of its spec")));
    EXPECT_THAT(found_after("CREATE TABLE gone AS SELECT * FROM report_blobs; DELETE FROM report_blobs",
                            "INSERT INTO report_blobs SELECT * FROM gone; DROP TABLE gone"),
                ElementsAre(HasSubstr("its pictures are not those that its text names"),
                            HasSubstr("no report names the picture")));
    damage("UPDATE blobs SET bytes = 'pictureX'");
    EXPECT_THROW(m_blobs.open(sha256_hex("picture")), DamagedData);
    EXPECT_THROW(m_store.care().check(true), StoreError);
    EXPECT_THROW(m_store.care().back_up(m_folder.path() / "backup"), StoreError);
}

TEST_P(PostgresStoreTest, ReportsOfAnotherStoreAreAdded) {
    const std::string id = make_done("done", "picture");
    const auto record = m_reports.find(id).value();
    ImportedReport report{.id = m_ids.next(),
                          .created_ms = 1'600'000'000'000,
                          .spec = record.spec,
                          .spec_sha256 = record.spec_sha256,
                          .finished = {.report = nlohmann::json::parse(record.report), .finished_ms = 7}};
    add_picture(report.finished, "picture");
    using Import = Care::Import;
    EXPECT_EQ(m_store.care().import_report(report), Import::added);
    EXPECT_EQ(m_store.care().import_report(report), Import::known);
    EXPECT_EQ(m_reports.find(report.id)->created_ms, report.created_ms);
    EXPECT_EQ(m_reports.find(report.id)->finished_ms, 7);
    damage("UPDATE blobs SET bytes = 'other'");
    EXPECT_EQ(m_store.care().import_report(report), Import::restored);
    EXPECT_EQ(picture(sha256_hex("picture")), "picture");
    report.finished.report["verdict"] = "failed";
    EXPECT_EQ(m_store.care().import_report(report), Import::differs);
    EXPECT_EQ(m_store.care().size().reports, 2);
    EXPECT_EQ(m_store.care().size().pictures, 1);
}

TEST_P(PostgresStoreTest, WhatNothingRefersToIsCollected) {
    const std::string id = make_done("done", "picture");
    damage("INSERT INTO blobs VALUES ('a', 'image/png', 3, 'abc'); INSERT INTO number_names VALUES (1, 'x', '[]')");
    const Garbage garbage = m_store.care().collect_garbage();
    EXPECT_EQ(garbage.rows, 2);
    EXPECT_EQ(garbage.bytes, 3u);
    EXPECT_EQ(m_store.care().collect_garbage().rows, 0);
    EXPECT_EQ(picture(sha256_hex("picture")), "picture");
}

TEST_P(PostgresStoreTest, ReportsHaveSizesForRetention) {
    const std::string shared(10'000, 'x');
    const std::string older = make_done("older", shared), newer = make_done("newer", shared);
    m_store.pins().pin({older, 0, "me", "why"});
    const auto stored = m_store.care().stored_reports();
    ASSERT_EQ(stored.size(), 2u);
    EXPECT_EQ(stored[0].id, newer);
    EXPECT_GT(stored[0].bytes, 10'000u);
    EXPECT_LT(stored[1].bytes, 1'000u) << "the picture counts for the newest report that names it";
    EXPECT_TRUE(stored[1].is_kept);
    EXPECT_FALSE(stored[0].is_kept);
}

TEST_P(PostgresStoreTest, NumbersAreKeptForTrends) {
    submit("one");
    const Lease job = lease();
    FinishedReport report = finished(job, "picture");
    report.numbers = {"[\"a\"]", std::string("\0\1\2", 3)};
    ASSERT_TRUE(m_queue.commit(job, report));
    const std::string without = make_done("two", "picture");
    auto found = m_store.trends().reports({.limit = 5});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].id, job.id);
    EXPECT_EQ(found[0].numbers->names, report.numbers.names);
    EXPECT_EQ(found[0].numbers->numbers, report.numbers.numbers);
    EXPECT_FALSE(found[1].numbers);
    m_store.trends().keep(without, {"[\"a\"]", "x"});
    EXPECT_EQ(m_store.trends().reports({.limit = 1}).at(0).numbers->numbers, "x");
}

TEST_P(PostgresStoreTest, WhatChildrenReadIsCopiedToThisMachine) {
    make_done("done", "picture");
    const std::string upload = add_asset("upload"), other = add_asset("other");
    const ContentFolder blobs(m_data.blobs()), assets(m_data.assets());
    EXPECT_FALSE(blobs.find(sha256_hex("picture")));
    const std::string text =
        fmt::format("{{\"a\": \"{}\", \"b\": \"/{}/\"}} {}0", sha256_hex("picture"), upload, other);
    m_store.bring_here(text);
    EXPECT_TRUE(blobs.is_whole(sha256_hex("picture")));
    EXPECT_TRUE(assets.is_whole(upload));
    EXPECT_FALSE(assets.find(other)) << "longer than a hash";
    EXPECT_EQ(m_assets.remove(upload), Assets::Removal::removed);
    m_store.bring_here(text);
    EXPECT_FALSE(assets.find(upload)) << "it was deleted";
    add_asset("upload");
    m_store.bring_here(text);
    std::filesystem::resize_file(*assets.find(upload), 2);
    m_store.bring_here(text);
    EXPECT_TRUE(assets.is_whole(upload));
    const auto old = std::filesystem::file_time_type::clock::now() - 48h;
    std::filesystem::last_write_time(*assets.find(upload), old);
    open()->bring_here("");
    EXPECT_FALSE(assets.find(upload)) << "it was not used for long";
    EXPECT_TRUE(blobs.find(sha256_hex("picture")));
}

std::vector<StoreKind> postgres_if_there_is_one() {
    if (!has_postgres()) return {};
    return {{"Postgres", in_postgres}};
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PostgresStoreTest);
INSTANTIATE_TEST_SUITE_P(Stores, PostgresStoreTest, testing::ValuesIn(postgres_if_there_is_one()), store_name);

}  // namespace
}  // namespace sheer::test::postgres_store_test
