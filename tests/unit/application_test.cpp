#include "server/http/application.h"

#include <gmock/gmock.h>

#include "server/http/report_view.h"
#include "server/http/service.h"
#include "server/http/text.h"
#include "store_fixture.h"

namespace sheer::http::application_test {
namespace {

using nlohmann::json;

class ApplicationTest : public test::WithStore {
  protected:
    ApplicationTest() {
        m_service.clock = m_clock;
        m_service.limits.max_queued = 2;
        m_service.limits.ready_within = std::chrono::seconds(10);
        m_service.list_devices = [] { return json::array({{{"name", "one"}}}); };
        m_application.emplace(make_guard(true, {}), make_router(m_service));
    }

    Answer ask(const std::string& method, const std::string& target,
               std::vector<std::pair<std::string, std::string>> headers = {}, const std::string& body = "") {
        Request request{.method = method, .target = target, .headers = {}, .body = body, .path_values = {}};
        for (auto& [name, value] : headers) request.headers.add(name, value);
        if (!request.headers.contains("Host")) request.headers.add("Host", "127.0.0.1:8080");
        return m_application->answer(std::move(request));
    }

    Response get(const std::string& target, std::vector<std::pair<std::string, std::string>> headers = {}) {
        return std::get<Response>(ask("GET", target, std::move(headers)));
    }

    Response post(const std::string& body, std::vector<std::pair<std::string, std::string>> headers = {}) {
        return std::get<Response>(ask("POST", "/api/v1/reports", std::move(headers), body));
    }

    static json body(const Response& response) { return json::parse(std::get<std::string>(response.body)); }

    static std::vector<std::string> pointers(const Response& response) {
        std::vector<std::string> all;
        const json read = body(response);
        for (const json& error : read.value("errors", json::array())) all.push_back(error["pointer"]);
        return all;
    }

    std::size_t stored() { return m_reports.list({}).reports.size(); }

    const std::string m_spec = R"({"scene": {"type": "layers", "layers": [{"rect": [0, 0, 1, 1], "depth": 0.5,
        "color": [1, 0, 0], "alpha": 0.5}]}, "methods": ["b2f"]})";
    Service m_service{.store = m_store, .ids = m_ids, .clock = {}, .list_devices = {}};
    std::optional<Application> m_application;
};

TEST_F(ApplicationTest, ASpecIsQueued) {
    const Response response = post(m_spec, {{"Content-Type", "application/json"}});
    EXPECT_EQ(response.status, 202);
    const json report = body(response);
    EXPECT_EQ(report["status"], "queued");
    EXPECT_EQ(report["progress"], 0);
    EXPECT_EQ(report["error"], nullptr);
    EXPECT_EQ(report["spec"]["methods"][0]["id"], "b2f");
    EXPECT_EQ(report["spec_sha256"], sha256_hex(report["spec"].dump()));
    const std::string location = response.headers.find("Location").value_or("");
    EXPECT_EQ(location, "/api/v1/reports/" + report["id"].get<std::string>());
    EXPECT_TRUE(response.headers.contains("Retry-After"));
    EXPECT_EQ(body(get(location)), report);
}

TEST_F(ApplicationTest, WrongSpecsAreNotStored) {
    EXPECT_EQ(post("{").status, 400);
    EXPECT_EQ(post("").status, 400);
    EXPECT_EQ(post("{\"a\": 1e999}").status, 400);
    EXPECT_EQ(post(std::string(500'000, '[')).status, 400);
    EXPECT_EQ(post("\"\xff\"").status, 400);
    EXPECT_EQ(post("[]").status, 422);
    EXPECT_EQ(post("{}").status, 422);
    EXPECT_EQ(post(m_spec, {{"Content-Type", "text/plain"}}).status, 415);
    const Response unknown = post(R"({"scene": {"type": "quads"}, "methods": ["b2f"], "spam": 1})");
    EXPECT_EQ(unknown.status, 422);
    EXPECT_THAT(pointers(unknown), testing::ElementsAre("/spam"));
    EXPECT_EQ(stored(), 0u);
}

TEST_F(ApplicationTest, AFullQueueSaysWhenToTryAgain) {
    EXPECT_EQ(post(m_spec).status, 202);
    EXPECT_EQ(post(m_spec).status, 202);
    const Response full = post(m_spec);
    EXPECT_EQ(full.status, 429);
    EXPECT_TRUE(full.headers.contains("Retry-After"));
    EXPECT_EQ(stored(), 2u);
}

TEST_F(ApplicationTest, TheQueueIsLimitedByWorkToo) {
    m_service.limits.max_queued_cost = 1;  // a comparison of 512 x 512 pixels has a cost of several megapixels
    EXPECT_EQ(post(m_spec).status, 202);
    const Response full = post(m_spec);
    EXPECT_EQ(full.status, 429);
    EXPECT_TRUE(full.headers.contains("Retry-After"));
    EXPECT_EQ(stored(), 1u);
}

TEST_F(ApplicationTest, WhatFailsSaysWhetherToTryAgain) {
    const auto failing = [&](auto error) {
        m_service.check_upload = [error](const std::string&, const std::string&) -> UploadVerdict { throw error; };
        return std::get<Response>(ask("POST", "/api/v1/assets", {{"Content-Type", "image/png"}}, "an upload"));
    };
    const Response unreachable = failing(StoreUnreachable("x")), broken = failing(DiskError("x"));
    EXPECT_EQ(unreachable.status, 503);
    EXPECT_TRUE(unreachable.headers.contains("Retry-After"));
    EXPECT_EQ(broken.status, 503);
    EXPECT_TRUE(broken.headers.contains("Retry-After"));
    EXPECT_EQ(failing(StoreFull("x")).status, 507);
    EXPECT_EQ(failing(DamagedData("x")).status, 500);
    EXPECT_EQ(failing(std::runtime_error("x")).status, 500);
}

TEST_F(ApplicationTest, AnIdempotencyKeyGivesTheSameReport) {
    const Response first = post(m_spec, {{"Idempotency-Key", "k"}});
    // The same document, written in another way.
    const Response again = post(json::parse(m_spec).dump(2), {{"Idempotency-Key", "k"}});
    EXPECT_EQ(again.status, 202);
    EXPECT_EQ(body(again)["id"], body(first)["id"]);
    json other = json::parse(m_spec);
    other["title"] = "other";
    EXPECT_EQ(post(other.dump(), {{"Idempotency-Key", "k"}}).status, 422);
    EXPECT_EQ(post(m_spec, {{"Idempotency-Key", std::string(256, 'k')}}).status, 400);
    EXPECT_EQ(stored(), 1u);
}

TEST_F(ApplicationTest, WaitingEndsWithTheReport) {
    auto waiting = std::get<Waiting>(ask("POST", "/api/v1/reports", {{"Prefer", "wait=5"}}, m_spec));
    EXPECT_EQ(waiting.limit, std::chrono::seconds(5));
    EXPECT_FALSE(waiting.ready());
    const Response meanwhile = waiting.otherwise();
    EXPECT_EQ(meanwhile.status, 202);
    EXPECT_EQ(meanwhile.headers.find("Preference-Applied"), "wait=5");
    const Lease job = lease();
    EXPECT_FALSE(waiting.ready());
    m_queue.commit(job, finished(job, "picture"));
    const auto ready = waiting.ready();
    ASSERT_TRUE(ready);
    EXPECT_EQ(ready->status, 200);
    EXPECT_EQ(ready->headers.find("Preference-Applied"), "wait=5");
    EXPECT_EQ(body(*ready)["status"], "done");
    m_reports.remove(job.id);
    EXPECT_EQ(waiting.ready()->status, 404);
}

TEST_F(ApplicationTest, WaitingIsLimited) {
    m_service.limits.max_wait = std::chrono::seconds(7);
    EXPECT_EQ(std::get<Waiting>(ask("POST", "/api/v1/reports", {{"Prefer", "wait=100000"}}, m_spec)).limit,
              std::chrono::seconds(7));
}

TEST_F(ApplicationTest, EventsFollowTheReport) {
    const std::string id = submit();
    const std::string target = "/api/v1/reports/" + id + "/events";
    auto stream = std::get<EventStream>(ask("GET", target));
    EXPECT_EQ(stream.head.headers.find("Content-Type"), "text/event-stream");
    const EventChunk first = stream.next();
    EXPECT_TRUE(first.text.starts_with("id: 1\nevent: progress\ndata: {"));
    EXPECT_EQ(stream.next().text, "");
    const Lease job = lease();
    m_queue.heartbeat(job, 0.5, "timing");
    const EventChunk half = stream.next();
    EXPECT_TRUE(half.text.starts_with("id: 3\n"));  // the start of the job and its progress in one event
    EXPECT_NE(half.text.find("\"progress\":0.5"), std::string::npos);
    EXPECT_FALSE(half.last);
    m_queue.commit(job, finished(job, "picture"));
    const EventChunk last = stream.next();
    EXPECT_TRUE(last.text.starts_with("id: 4\nevent: done\n"));
    EXPECT_TRUE(last.last);
    // A client that reconnects gets what it missed, or learns that nothing more will come.
    auto resumed = std::get<EventStream>(ask("GET", target, {{"Last-Event-ID", "3"}}));
    EXPECT_EQ(resumed.next().text, last.text);
    EXPECT_EQ(get(target, {{"Last-Event-ID", "4"}}).status, 204);
}

TEST_F(ApplicationTest, EventsReportFailureAndCancellation) {
    submit();
    const Lease job = lease();
    auto stream = std::get<EventStream>(ask("GET", "/api/v1/reports/" + job.id + "/events"));
    m_queue.fail(job, {"Rendering failed", "why"}, false);
    const EventChunk failed = stream.next();
    EXPECT_NE(failed.text.find("event: failed\n"), std::string::npos);
    EXPECT_NE(failed.text.find("\"detail\":\"why\""), std::string::npos);
    EXPECT_TRUE(failed.last);
    const std::string queued = submit();
    auto other = std::get<EventStream>(ask("GET", "/api/v1/reports/" + queued + "/events"));
    m_reports.remove(queued);
    EXPECT_NE(other.next().text.find("event: cancelled\n"), std::string::npos);
    auto deleted = std::get<EventStream>(ask("GET", "/api/v1/reports/" + queued + "/events"));
    m_reports.remove(queued);
    EXPECT_TRUE(deleted.next().last);
}

TEST_F(ApplicationTest, AFailedReportSaysWhy) {
    submit();
    const Lease job = lease();
    m_queue.fail(job, {"Rendering failed", "The renderer died (signal 11)."}, false);
    const json report = body(get("/api/v1/reports/" + job.id));
    EXPECT_EQ(report["status"], "failed");
    EXPECT_EQ(report["error"], (json{{"title", "Rendering failed"}, {"detail", "The renderer died (signal 11)."}}));
    EXPECT_EQ(get("/api/v1/reports/" + job.id + "/report.html").status, 409);
    const Response junit = get("/api/v1/reports/" + job.id + "/junit.xml");
    EXPECT_EQ(junit.status, 200);
    EXPECT_THAT(std::get<std::string>(junit.body), testing::HasSubstr("errors=\"1\""));
}

TEST_F(ApplicationTest, DeletionDependsOnTheStatus) {
    const auto remove = [&](const std::string& id) {
        return std::get<Response>(ask("DELETE", "/api/v1/reports/" + id)).status;
    };
    const std::string queued = submit();
    EXPECT_EQ(remove(queued), 200);
    EXPECT_EQ(remove(queued), 204);
    EXPECT_EQ(remove(queued), 404);
    const std::string running = submit();
    lease();
    EXPECT_EQ(remove(running), 202);
}

TEST_F(ApplicationTest, PicturesAreServedAsImmutable) {
    make_done("done", "picture");
    const std::string sha256 = sha256_hex("picture");
    const Response response = get("/api/v1/blobs/" + sha256);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(read_all(*std::get<ContentPtr>(response.body), 100), "picture");
    EXPECT_EQ(response.headers.find("Content-Type"), "image/png");
    EXPECT_EQ(response.headers.find("ETag"), "\"" + sha256 + "\"");
    EXPECT_THAT(*response.headers.find("Cache-Control"), testing::HasSubstr("immutable"));
    EXPECT_EQ(get("/api/v1/blobs/" + sha256, {{"If-None-Match", "\"" + sha256 + "\""}}).status, 304);
    EXPECT_EQ(get("/api/v1/blobs/" + std::string(64, '0')).status, 404);
    EXPECT_EQ(get("/api/v1/blobs/..%2F..%2Farchive.sqlite").status, 404);
}

TEST_F(ApplicationTest, AnEtagChangesWithTheReport) {
    const std::string id = submit();
    const std::string etag = get("/api/v1/reports/" + id).headers.find("ETag").value();
    EXPECT_EQ(get("/api/v1/reports/" + id, {{"If-None-Match", etag}}).status, 304);
    lease();
    EXPECT_EQ(get("/api/v1/reports/" + id, {{"If-None-Match", etag}}).status, 200);
}

TEST_F(ApplicationTest, TheListContinuesAtItsCursor) {
    for (const char* title : {"a", "b", "c"}) submit(title);
    const json first = body(get("/api/v1/reports?limit=2"));
    EXPECT_EQ(first["reports"][0]["title"], "c");
    const json second = body(get("/api/v1/reports?limit=2&cursor=" + first["next_cursor"].get<std::string>()));
    EXPECT_EQ(second["reports"].size(), 1u);
    EXPECT_EQ(second["reports"][0]["title"], "a");
    EXPECT_EQ(second["next_cursor"], nullptr);
    EXPECT_THAT(pointers(get("/api/v1/reports?cursor=x&limit=1")), testing::ElementsAre("/cursor"));
    EXPECT_THAT(pointers(get("/api/v1/reports?limit=0&status=odd")),
                testing::UnorderedElementsAre("/limit", "/status"));
    EXPECT_EQ(body(get("/api/v1/reports?status=done"))["reports"].size(), 0u);
}

TEST_F(ApplicationTest, ReadyMeansThatAWorkerRenderedRecently) {
    EXPECT_EQ(get("/healthz").status, 200);
    EXPECT_EQ(get("/readyz").status, 503);
    m_readiness.note_rendered();
    EXPECT_EQ(get("/readyz").status, 200);
    m_now_ms += 10'001;
    EXPECT_EQ(get("/readyz").status, 503);
    EXPECT_EQ(get("/healthz").status, 200);
}

TEST_F(ApplicationTest, OtherSitesAreRefused) {
    const auto status = [&](const char* method, std::vector<std::pair<std::string, std::string>> headers) {
        return std::get<Response>(ask(method, "/api/v1/reports", std::move(headers), m_spec)).status;
    };
    EXPECT_EQ(status("GET", {{"Host", "evil.example"}}), 421);
    EXPECT_EQ(status("GET", {{"Host", "127.0.0.1.evil.example:8080"}}), 421);
    EXPECT_EQ(status("GET", {{"Host", ""}}), 421);
    for (const char* host :
         {"[::1]evil.example", "[::1].evil.example:80", "localhost:80evil.example", "[::1", "localhost:80:80"})
        EXPECT_EQ(status("GET", {{"Host", host}}), 421) << host;
    EXPECT_EQ(status("GET", {{"Host", "[::1]:8080"}}), 200);
    EXPECT_EQ(status("GET", {{"Host", "localhost"}}), 200);
    EXPECT_EQ(status("GET", {{"Host", "[::1]:80"}}), 200);
    EXPECT_EQ(status("POST", {{"Origin", "http://evil.example"}}), 403);
    EXPECT_EQ(status("POST", {{"Origin", "null"}}), 403);
    EXPECT_EQ(status("POST", {{"Origin", "http://127.0.0.1:8081"}}), 403);
    EXPECT_EQ(status("POST", {{"Sec-Fetch-Site", "cross-site"}}), 403);
    EXPECT_EQ(status("DELETE", {{"Origin", "http://evil.example"}}), 403);
    EXPECT_EQ(stored(), 0u);
    EXPECT_EQ(status("POST", {{"Origin", "http://127.0.0.1:8080"}, {"Sec-Fetch-Site", "same-origin"}}), 202);
}

TEST(GuardTest, BeyondLoopbackAnyNameIsAllowedUnlessSomeAreListed) {
    Request request{.method = "GET", .target = "/", .headers = {}, .body = "", .path_values = {}};
    request.headers.add("Host", "sheer.example:80");
    EXPECT_TRUE(make_guard(true, {}).refusal(request));
    EXPECT_FALSE(make_guard(true, {"sheer.example"}).refusal(request));
    EXPECT_FALSE(make_guard(false, {}).refusal(request));
    EXPECT_TRUE(make_guard(false, {"other.example"}).refusal(request));
}

TEST_F(ApplicationTest, PagesOfConfiguredOriginsMayAskAndRead) {
    m_application.emplace(make_guard(true, {}, {"https://ci.example"}), make_router(m_service));
    const auto from = [](const char* origin) { return std::pair<std::string, std::string>{"Origin", origin}; };
    const std::pair<std::string, std::string> cross{"Sec-Fetch-Site", "cross-site"};
    const Response preflight = std::get<Response>(ask(
        "OPTIONS", "/api/v1/reports", {from("https://ci.example"), cross, {"Access-Control-Request-Method", "POST"}}));
    EXPECT_EQ(preflight.status, 204);
    EXPECT_EQ(preflight.headers.find("Access-Control-Allow-Origin"), "https://ci.example");
    EXPECT_EQ(preflight.headers.find("Access-Control-Allow-Methods"), "POST, GET, HEAD, OPTIONS");
    EXPECT_NE(preflight.headers.find("Access-Control-Allow-Headers")->find("Idempotency-Key"), std::string::npos);
    const Response posted = post(m_spec, {from("https://ci.example"), cross});
    EXPECT_EQ(posted.status, 202);
    EXPECT_EQ(posted.headers.find("Access-Control-Allow-Origin"), "https://ci.example");
    EXPECT_NE(posted.headers.find("Access-Control-Expose-Headers")->find("Retry-After"), std::string::npos);
    EXPECT_EQ(post(m_spec, {from("https://other.example"), cross}).status, 403);
    const Response other = get("/api/v1/methods", {from("https://other.example")});
    EXPECT_FALSE(other.headers.contains("Access-Control-Allow-Origin"));
    EXPECT_NE(other.headers.joined("Vary")->find("Origin"), std::string::npos);
}

TEST(GuardTest, AnOriginHasNoPath) {
    EXPECT_EQ(wrong_origin("https://ci.example"), "");
    EXPECT_EQ(wrong_origin("http://127.0.0.1:3000"), "");
    for (const char* wrong : {"*", "", "ci.example", "https://ci.example/", "ftp://ci.example", "https://a@ci.example"})
        EXPECT_NE(wrong_origin(wrong), "") << wrong;
}

TEST_F(ApplicationTest, AnswersOnlyInFormsThatAreAccepted) {
    const Response refused = post(m_spec, {{"Accept", "text/html"}});
    EXPECT_EQ(refused.status, 406);
    EXPECT_EQ(refused.headers.find("Content-Type"), "application/problem+json");
    EXPECT_EQ(stored(), 0u);
    EXPECT_EQ(get("/api/v1/methods", {{"Accept", "application/json;q=0"}}).status, 406);
    EXPECT_EQ(get("/api/v1/methods", {{"Accept", "text/html, */*;q=0.1"}}).status, 200);
    EXPECT_EQ(get("/", {{"Accept", "application/json"}}).status, 200);
}

TEST_F(ApplicationTest, CompressedBodiesAreRefused) {
    const Response refused = post(m_spec, {{"Content-Encoding", "gzip"}});
    EXPECT_EQ(refused.status, 415);
    EXPECT_EQ(refused.headers.find("Accept-Encoding"), "identity");
    EXPECT_EQ(stored(), 0u);
    EXPECT_EQ(post(m_spec, {{"Content-Encoding", "identity"}}).status, 202);
}

TEST_F(ApplicationTest, AClientThatHasTheCompressedFormGetsA304) {
    const Response packed = get("/api/v1/methods", {{"Accept-Encoding", "gzip"}});
    const std::string etag = packed.headers.find("ETag").value_or("");
    EXPECT_TRUE(etag.ends_with("-gzip\"")) << etag;
    for (const char* coding : {"gzip", "identity"}) {
        const Response known = get("/api/v1/methods", {{"Accept-Encoding", coding}, {"If-None-Match", etag}});
        EXPECT_EQ(known.status, 304) << coding;
        EXPECT_EQ(std::get<std::string>(known.body), "");
    }
}

TEST_F(ApplicationTest, UnknownMethodsGetTheAllowedOnes) {
    const Response options = std::get<Response>(ask("OPTIONS", "/api/v1/reports"));
    EXPECT_EQ(options.status, 204);
    EXPECT_EQ(options.headers.find("Allow"), "POST, GET, HEAD, OPTIONS");
    const Response put = std::get<Response>(ask("PUT", "/api/v1/reports"));
    EXPECT_EQ(put.status, 405);
    EXPECT_EQ(put.headers.find("Allow"), "POST, GET, HEAD, OPTIONS");
    EXPECT_EQ(get("/api/v1/nothing").status, 404);
    EXPECT_EQ(get("/../etc/passwd").status, 404);
}

TEST_F(ApplicationTest, EveryAnswerIsGuardedAgainstSniffing) {
    for (const char* target : {"/healthz", "/readyz", "/api/v1/reports", "/nothing", "/api/v1/openapi.json"}) {
        const Headers headers = get(target).headers;
        EXPECT_EQ(headers.find("X-Content-Type-Options"), "nosniff") << target;
        EXPECT_TRUE(headers.contains("Content-Security-Policy")) << target;
        EXPECT_EQ(headers.find("Cross-Origin-Resource-Policy"), "same-origin") << target;
    }
}

TEST_F(ApplicationTest, InternalErrorsAreNotExplainedToTheClient) {
    m_service.list_devices = []() -> json { throw std::runtime_error("secret"); };
    const Response devices = get("/api/v1/devices");
    EXPECT_EQ(devices.status, 503);
    EXPECT_EQ(std::get<std::string>(devices.body).find("secret"), std::string::npos);
}

TEST_F(ApplicationTest, APixelIsExplainedInTheRequestedRun) {
    PixelAnswer answer{.json = R"({"x": 3})", .refusal = ""};
    std::vector<int> asked;
    m_service.pixel = [&](const std::string& report, const PixelPlace& place) {
        EXPECT_EQ(json::parse(report)["runs"].size(), 2u);
        asked = {place.x, place.y, place.run};
        return answer;
    };
    const std::string id = body(post(m_spec))["id"];
    const std::string pixel = "/api/v1/reports/" + id + "/pixel";
    EXPECT_EQ(get(pixel + "?x=0&y=0").status, 409) << "not done";
    const Lease job = lease();
    FinishedReport report = finished(job, "picture");
    report.report["spec"] = {{"image", {{"width", 4}, {"height", 8}}}};
    report.report["runs"] = {{{"point", json::object()}}, {{"point", {{"/image/width", 6}}}}};
    m_queue.commit(job, report);
    EXPECT_EQ(body(get(pixel + "?x=5&y=7&run=1"))["x"], 3);
    EXPECT_EQ(asked, (std::vector{5, 7, 1}));
    const Response outside = get(pixel + "?x=5&y=8");
    EXPECT_EQ(outside.status, 422);
    EXPECT_THAT(pointers(outside), testing::ElementsAre("/x", "/y"));
    EXPECT_THAT(pointers(get(pixel + "?y=a")), testing::UnorderedElementsAre("/x", "/y"));
    EXPECT_EQ(get("/api/v1/reports/none/pixel?x=0&y=0").status, 404);
    answer = {.json = "", .refusal = "its model is gone"};
    EXPECT_EQ(get(pixel + "?x=0&y=0").status, 409);
    answer.too_slow = true;
    EXPECT_EQ(get(pixel + "?x=0&y=0").status, 503);
}

/// Every "$ref" in `value`.
void collect_references(const json& value, std::vector<std::string>& references) {
    if (value.is_object() && value.contains("$ref")) references.push_back(value["$ref"]);
    if (value.is_structured())
        for (const json& inner : value) collect_references(inner, references);
}

TEST_F(ApplicationTest, TheOpenapiDocumentDescribesEveryCall) {
    const json document = body(get("/api/v1/openapi.json"));
    EXPECT_EQ(document["openapi"], "3.1.0");
    std::size_t described = 0;
    for (const auto& [path, operations] : document["paths"].items()) described += operations.size();
    std::size_t calls = 0;
    const Router router = make_router(m_service);
    for (const Route& route : router.routes()) {
        const bool of_page =
            !route.pattern.starts_with("/api/") && route.pattern != "/healthz" && route.pattern != "/readyz";
        EXPECT_EQ(route.id.empty(), of_page) << route.pattern;
        calls += !of_page;
    }
    EXPECT_EQ(described, calls);
    EXPECT_EQ(calls, 44u);
    std::vector<std::string> references;
    collect_references(document["paths"], references);
    EXPECT_FALSE(references.empty());
    for (const std::string& reference : references)
        EXPECT_TRUE(document.contains(json::json_pointer(reference.substr(1)))) << reference;
    const json& list = document["paths"]["/api/v1/reports"]["get"]["parameters"];
    EXPECT_EQ(list.size(), 12u);
    EXPECT_EQ(list[0]["schema"]["maximum"], 100);
    EXPECT_EQ(list[0]["required"], false);
    const json& diff = document["paths"]["/api/v1/reports/{id}/diff"]["get"]["parameters"];
    EXPECT_EQ(diff[1]["name"], "against");
    EXPECT_EQ(diff[1]["required"], true);
}

}  // namespace
}  // namespace sheer::http::application_test
