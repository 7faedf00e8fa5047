#include "server/http/preconditions.h"

#include <gmock/gmock.h>

#include "renderer/core/sha256.h"
#include "server/http/application.h"
#include "server/http/service.h"
#include "store_fixture.h"

namespace sheer::http::preconditions_test {
namespace {

using nlohmann::json;
using Fields = std::vector<std::pair<std::string, std::string>>;

class PreconditionsTest : public test::WithStore {
  protected:
    PreconditionsTest() { m_service.clock = m_clock; }

    Response ask(const std::string& method, const std::string& target, const Fields& fields = {},
                 const std::string& body = "") {
        Request request{.method = method, .target = target, .headers = {}, .body = body, .path_values = {}};
        for (const auto& [name, value] : fields) request.headers.add(name, value);
        if (!request.headers.contains("Host")) request.headers.add("Host", "localhost");
        return std::get<Response>(m_application.answer(std::move(request)));
    }

    std::string etag(const std::string& path) { return ask("GET", path).headers.find("ETag").value_or("none"); }

    const std::string m_reports_path = "/api/v1/reports", m_assets_path = "/api/v1/assets";
    Service m_service{.store = m_store, .ids = m_ids, .clock = {}, .list_devices = {}};
    const Application m_application{make_guard(true, {}), make_router(m_service)};
};

TEST_F(PreconditionsTest, ADeletionWithAnUnsatisfiedConditionDoesNothing) {
    const std::string id = submit(), path = m_reports_path + "/" + id, tag = etag(path);
    for (const Fields& fields :
         {Fields{{"If-None-Match", "*"}}, Fields{{"If-None-Match", tag}}, Fields{{"If-None-Match", "W/" + tag}},
          Fields{{"If-None-Match", "\"x\", " + tag}}, Fields{{"If-None-Match", "\"x\""}, {"If-None-Match", tag}},
          Fields{{"If-Match", "\"x\""}}, Fields{{"If-Match", "W/" + tag}},
          Fields{{"If-Match", tag}, {"If-None-Match", "*"}}}) {
        EXPECT_EQ(ask("DELETE", path, fields).status, 412) << fields[0].first << ": " << fields[0].second;
        EXPECT_EQ(status(id), Status::queued);
    }
    EXPECT_EQ(ask("DELETE", path, {{"If-Match", "\"x\", " + tag}}).status, 200);
    EXPECT_EQ(status(id), Status::cancelled);
    // The first request changed it.
    EXPECT_EQ(ask("DELETE", path, {{"If-Match", tag}}).status, 412);
    EXPECT_EQ(ask("DELETE", path, {{"If-Match", "*"}, {"If-None-Match", "\"x\""}}).status, 204);
    EXPECT_EQ(ask("DELETE", path, {{"If-None-Match", "*"}}).status, 404);
}

TEST_F(PreconditionsTest, AnAssetIsDeletedOnlyByItsWholeHash) {
    const std::string sha256 = add_asset("picture"), path = m_assets_path + "/" + sha256;
    submit("waits", {{"scene", {{"type", "quads"}, {"texture", {{"image", sha256}}}}}});
    for (const std::string& part : {std::string("a"), sha256.substr(0, 63), sha256 + "0", std::string("%20")})
        EXPECT_EQ(ask("DELETE", m_assets_path + "/" + part).status, 404) << part;
    EXPECT_EQ(ask("DELETE", path, {{"If-None-Match", "*"}}).status, 412);
    EXPECT_EQ(ask("DELETE", path).status, 409);
    m_reports.remove(lease().id);
    m_now_ms += m_rules.lease_ms + 1;
    m_queue.lease("another");
    EXPECT_EQ(ask("DELETE", path, {{"If-Match", "\"" + sha256 + "\""}}).status, 204);
    EXPECT_EQ(ask("DELETE", path).status, 404);
}

TEST_F(PreconditionsTest, NothingIsQueuedWithAnUnsatisfiedCondition) {
    const std::string spec = R"({"scene": {"type": "quads"}, "methods": ["b2f"]})";
    EXPECT_EQ(ask("POST", m_reports_path, {{"If-None-Match", "*"}}, spec).status, 412);
    EXPECT_EQ(ask("POST", m_reports_path, {{"If-Match", "\"x\""}}, spec).status, 412);
    EXPECT_TRUE(m_reports.list({}).reports.empty());
    EXPECT_EQ(ask("POST", m_reports_path, {{"If-None-Match", "\"x\""}}, spec).status, 202);
    EXPECT_EQ(ask("POST", "/api/v1/specs/validate", {{"If-Match", "*"}}, spec).status, 200);
}

TEST_F(PreconditionsTest, AReaderWithTheCurrentVersionGetsNotModified) {
    const std::string path = m_reports_path + "/" + submit(), tag = etag(path);
    for (const char* method : {"GET", "HEAD"}) {
        EXPECT_EQ(ask(method, path, {{"If-None-Match", tag}}).status, 304);
        EXPECT_EQ(ask(method, path, {{"If-None-Match", "*"}}).status, 304);
        EXPECT_EQ(ask(method, path, {{"If-None-Match", "\"x\""}}).status, 200);
        EXPECT_EQ(ask(method, path, {{"If-Match", tag}}).status, 200);
        EXPECT_EQ(ask(method, path, {{"If-Match", "\"x\""}}).status, 412);
    }
    EXPECT_EQ(ask("GET", m_reports_path + "/x", {{"If-None-Match", "*"}}).status, 404);
    EXPECT_EQ(ask("OPTIONS", path, {{"If-None-Match", "*"}}).status, 204);
}

TEST_F(PreconditionsTest, ProbesAreAnsweredForAnyHost) {
    for (const Fields& fields : {Fields{{"Host", "10.42.0.7:9231"}}, Fields{{"Host", ""}}}) {
        EXPECT_EQ(ask("GET", "/healthz", fields).status, 200);
        EXPECT_EQ(ask("HEAD", "/healthz", fields).status, 200);
        EXPECT_EQ(ask("GET", "/readyz", fields).status, 503);
        EXPECT_EQ(ask("GET", m_reports_path, fields).status, 421);
        EXPECT_EQ(ask("DELETE", "/healthz", fields).status, 421);
    }
    EXPECT_EQ(m_application.handling("GET", "/healthz").lane, Lane::at_once);
    EXPECT_TRUE(m_application.handling("GET", "/readyz").is_probe);
    EXPECT_FALSE(m_application.handling("GET", m_reports_path).is_probe);
    EXPECT_EQ(m_application.handling("POST", m_reports_path + "?x=/healthz").lane, Lane::specs);
}

TEST_F(PreconditionsTest, TheAnswerToAWrongSpecIsBounded) {
    json spec = {{"scene", {{"type", "quads"}}}, {"methods", {"b2f"}}};
    for (int i = 0; i < 5000; ++i) spec["field " + std::to_string(i)] = i;
    const Response response = ask("POST", "/api/v1/specs/validate", {}, spec.dump());
    EXPECT_EQ(response.status, 422);
    const json problem = json::parse(std::get<std::string>(response.body));
    EXPECT_EQ(problem["errors"].size(), 100u);
    EXPECT_EQ(problem["error_count"], 5000);
    EXPECT_FALSE(problem["errors"][99]["detail"].get<std::string>().empty());
    EXPECT_LT(std::get<std::string>(response.body).size(), 100'000u);
}

TEST_F(PreconditionsTest, ABodyIsOneJsonDocumentWithEachKeyOnce) {
    using namespace std::string_literals;
    const std::string spec = R"({"scene": {"type": "quads"}, "methods": ["b2f"]})";
    for (const std::string& behind : {"\0"s, "\0{}"s, "x"s, "{}"s, ","s})
        EXPECT_EQ(ask("POST", m_reports_path, {}, spec + behind).status, 400);
    const Response twice = ask("POST", m_reports_path, {}, R"({"scene": {"type": "quads", "count": 1, "count": 2}})");
    EXPECT_EQ(twice.status, 422);
    EXPECT_EQ(json::parse(std::get<std::string>(twice.body))["errors"][0]["pointer"], "/scene/count");
    EXPECT_EQ(ask("POST", m_reports_path, {}, spec + " \n\t").status, 202);
}

}  // namespace
}  // namespace sheer::http::preconditions_test
