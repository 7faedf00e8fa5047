// Done reports that the service keeps in memory, while others write to the same archive.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "server/http/application.h"
#include "server/http/service.h"
#include "store_fixture.h"

namespace sheer::http::known_report_test {
namespace {

class KnownReportTest : public test::WithSqlite {
  protected:
    using Fields = std::vector<std::pair<std::string, std::string>>;

    static Request request(const std::string& id, const Fields& fields, const std::string& method) {
        Request request{.method = method, .target = "/api/v1/reports/" + id};
        request.headers.add("Host", "localhost");
        for (const auto& [name, value] : fields) request.headers.add(name, value);
        return request;
    }
    std::optional<Response> known(const std::string& id, const Fields& fields = {}, const std::string& method = "GET") {
        return m_application.known(request(id, fields, method));
    }
    Response answer(const std::string& id, const Fields& fields = {}) {
        return std::get<Response>(m_application.answer(request(id, fields, "GET")));
    }
    /// The statuses of two requests, of which the second could be answered from memory.
    std::pair<int, int> twice(const std::string& id) {
        const int first = answer(id).status;
        const auto second = known(id);
        return {first, second ? second->status : 0};
    }

    Service m_service{.store = m_store, .ids = m_ids, .clock = m_clock, .list_devices = {}};
    Application m_application{make_guard(true, {}), make_router(m_service)};
    /// Of another process.
    const std::unique_ptr<Store> m_other = m_place->open(m_rules, m_clock);
};

TEST_F(KnownReportTest, ADoneReportIsKnownOnceItWasRead) {
    const std::string id = make_done("a", "picture");
    EXPECT_FALSE(known(id));
    const Response read = answer(id);
    const auto again = known(id);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->status, 200);
    EXPECT_EQ(again->body, read.body);
    EXPECT_EQ(again->headers.fields(), read.headers.fields());
    EXPECT_FALSE(known(make_done("b", "picture")));
}

TEST_F(KnownReportTest, OnlyWhatIsDoneIsKnown) {
    const std::string queued = submit("queued");
    EXPECT_EQ(twice(queued), std::pair(200, 0));
    EXPECT_EQ(twice("nothing"), std::pair(404, 0));
    const Lease job = lease();
    ASSERT_TRUE(m_queue.commit(job, finished(job, "picture")));
    EXPECT_EQ(twice(queued), std::pair(200, 200));
}

TEST_F(KnownReportTest, AReportThatAnotherProcessDeletedIsGoneAtOnce) {
    const std::string id = make_done("a", "picture"), other = make_done("b", "picture");
    EXPECT_EQ(twice(id), std::pair(200, 200));
    EXPECT_EQ(twice(other), std::pair(200, 200));
    ASSERT_EQ(m_other->reports().remove(id), ReportArchive::Removal::deleted);
    EXPECT_FALSE(known(id));
    EXPECT_EQ(answer(id).status, 404);
    EXPECT_FALSE(known(other)) << "that it is still there is not known";
    EXPECT_EQ(twice(other), std::pair(200, 200));
}

TEST_F(KnownReportTest, AReportThatThisProcessDeletedIsGoneAtOnce) {
    const std::string id = make_done("a", "picture");
    EXPECT_EQ(twice(id), std::pair(200, 200));
    ASSERT_EQ(m_reports.remove(id), ReportArchive::Removal::deleted);
    EXPECT_EQ(twice(id), std::pair(404, 0));
}

TEST_F(KnownReportTest, ADamagedReportIsNotKnown) {
    const std::string one = make_done("one", "a"), two = make_done("two", "b");
    EXPECT_EQ(twice(one), std::pair(200, 200));
    SQLite::Database database(m_data.database().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TRIGGER documents_final");
    database.exec("UPDATE documents SET packed = (SELECT packed FROM documents WHERE report_id = '" + two +
                  "') WHERE report_id = '" + one + "'");
    EXPECT_EQ(twice(one), std::pair(500, 0));
}

TEST_F(KnownReportTest, PreconditionsHoldForWhatIsKnown) {
    const std::string id = make_done("a", "picture");
    const std::string etag = answer(id).headers.find("ETag").value_or("");
    ASSERT_NE(etag, "");
    const auto unchanged = known(id, {{"If-None-Match", etag}});
    ASSERT_TRUE(unchanged);
    EXPECT_EQ(unchanged->status, 304);
    EXPECT_EQ(std::get<std::string>(unchanged->body), "");
    EXPECT_EQ(known(id, {{"If-None-Match", "\"another\""}})->status, 200);
    EXPECT_EQ(known(id, {{"If-Match", "\"another\""}})->status, 412);
    EXPECT_EQ(known(id, {{"Accept", "image/png"}})->status, 406);
    EXPECT_EQ(known(id, {}, "HEAD")->status, 200);
}

TEST_F(KnownReportTest, NothingIsCompressedOnTheThreadOfTheConnections) {
    submit("a");
    const Lease job = lease();
    FinishedReport long_one = finished(job, "picture");
    long_one.report["padding"] = std::string(5000, 'x');
    ASSERT_TRUE(m_queue.commit(job, long_one));
    const std::string& id = job.id;
    const Fields gzip = {{"Accept-Encoding", "gzip"}};
    EXPECT_EQ(answer(id).status, 200);
    EXPECT_FALSE(known(id, gzip));
    const Response packed = answer(id, gzip);
    EXPECT_EQ(packed.headers.find("Content-Encoding"), "gzip");
    const auto again = known(id, gzip);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->body, packed.body);
}

TEST_F(KnownReportTest, HandlingSaysWhatMayBeKnown) {
    EXPECT_TRUE(m_application.handling("GET", "/api/v1/reports/x").may_be_known);
    EXPECT_TRUE(m_application.handling("HEAD", "/api/v1/reports/x?").may_be_known);
    EXPECT_FALSE(m_application.handling("DELETE", "/api/v1/reports/x").may_be_known);
    EXPECT_FALSE(m_application.handling("GET", "/api/v1/reports").may_be_known);
}

}  // namespace
}  // namespace sheer::http::known_report_test
