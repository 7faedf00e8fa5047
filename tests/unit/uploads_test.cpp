// Uploaded files in the service: the child process that reads them, and the calls.
#include <gmock/gmock.h>

#include <utility>

#include "server/children/upload_check.h"
#include "server/http/application.h"
#include "server/http/service.h"
#include "store_fixture.h"

namespace sheer::test::uploads_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using namespace std::chrono_literals;

class UploadCheckTest : public testing::Test {
  protected:
    /// $1 is check-asset, $2 the file, $3 --type, $4 the media type.
    UploadVerdict check_with(const std::string& script, const std::string& bytes = "bytes",
                             std::chrono::milliseconds time_limit = 20s) {
        ChildLimits options{.time = time_limit};
        options.program = m_folder.file("checker", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(options.program, std::filesystem::perms::owner_all);
        return check_upload(bytes, "image/png", options);
    }

    TemporaryFolder m_folder;
};

TEST_F(UploadCheckTest, TheChildGetsTheBytesAndTheType) {
    const std::string script = R"sh(printf '{"facts": {"said": "%s %s"}}\n' "$4" "$(cat "$2")")sh";
    const UploadVerdict verdict = check_with(script, "of the upload");
    EXPECT_EQ(verdict.refusal, "");
    EXPECT_EQ(verdict.facts, (json{{"said", "image/png of the upload"}}));
}

TEST_F(UploadCheckTest, AnythingElseIsARefusal) {
    EXPECT_EQ(check_with(R"(echo '{"refusal": "it is green"}')").refusal, "it is green");
    EXPECT_THAT(check_with("kill -SEGV $$").refusal, HasSubstr("crashes on it"));
    EXPECT_THAT(check_with(R"(echo '{"facts": {}}'; exit 3)").refusal, HasSubstr("crashes on it"));
    EXPECT_THAT(check_with("sleep 60", "", 50ms).refusal, HasSubstr("longer than 0.05 s"));
    for (const char* line : {"", "[]", "{", R"({"facts": 1})", R"({"refusal": {}})"})
        EXPECT_THAT(check_with("echo '" + std::string(line) + "'").refusal, HasSubstr("no valid answer")) << line;
}

class AssetCallsTest : public WithStore {
  protected:
    AssetCallsTest() {
        m_service.clock = m_clock;
        m_service.check_upload = [this](const std::string&, const std::string&) {
            if (const auto action = std::exchange(m_while_checking, nullptr)) action();
            return UploadVerdict{"", json::object()};
        };
        m_service.limits.max_checks = 1;
        m_application.emplace(http::make_guard(true, {}), http::make_router(m_service));
    }

    http::Response post(const std::string& target, const std::string& type, const std::string& body) {
        http::Request request{.method = "POST", .target = target, .headers = {}, .body = body, .path_values = {}};
        request.headers.add("Host", "127.0.0.1:8080");
        request.headers.add("Content-Type", type);
        return std::get<http::Response>(m_application->answer(std::move(request)));
    }

    static std::string detail(const http::Response& response) {
        return json::parse(std::get<std::string>(response.body))["detail"];
    }

    http::Service m_service{.store = m_store, .ids = m_ids, .clock = {}, .list_devices = {}};
    std::function<void()> m_while_checking;
    std::optional<http::Application> m_application;
};

TEST_F(AssetCallsTest, ASpecGetsAnAssetOfItsType) {
    const std::string model = add_asset("bytes", "model");
    const json spec = {{"scene", {{"type", "quads"}, {"texture", {{"image", model}}}}}, {"methods", {"b2f"}}};
    const http::Response response = post("/api/v1/reports", "application/json", spec.dump());
    EXPECT_EQ(response.status, 422);
    const json error = json::parse(std::get<std::string>(response.body))["errors"][0];
    EXPECT_EQ(error["pointer"], "/scene/texture/image");
    EXPECT_THAT(error["detail"].get<std::string>(), HasSubstr("is a model (image/png), not a texture"));
    EXPECT_TRUE(m_reports.list({}).reports.empty());
}

TEST_F(AssetCallsTest, TheSameBytesHaveOneType) {
    EXPECT_EQ(post("/api/v1/assets", "image/png", "bytes").status, 201);
    EXPECT_EQ(post("/api/v1/assets", "image/png", "bytes").status, 200);
    const http::Response other = post("/api/v1/assets", "image/jpeg", "bytes");
    EXPECT_EQ(other.status, 409);
    EXPECT_THAT(detail(other), HasSubstr("as image/png"));
}

TEST_F(AssetCallsTest, OnlyAFewAreReadAtTheSameTime) {
    http::Response second;
    m_while_checking = [&] { second = post("/api/v1/assets", "image/png", "second"); };
    EXPECT_EQ(post("/api/v1/assets", "image/png", "first").status, 201);
    EXPECT_EQ(second.status, 429);
    EXPECT_TRUE(second.headers.contains("Retry-After"));
    EXPECT_EQ(post("/api/v1/assets", "image/png", "second").status, 201);
}

TEST_F(AssetCallsTest, UploadsHaveTheirOwnLimit) {
    m_service.limits.max_asset_bytes = 12345;
    m_application.emplace(http::make_guard(true, {}), http::make_router(m_service));
    EXPECT_EQ(m_application->handling("POST", "/api/v1/assets?name=a").body_bytes, 12345u);
    EXPECT_EQ(m_application->handling("GET", "/api/v1/assets").body_bytes, std::nullopt);
    EXPECT_EQ(m_application->handling("POST", "/api/v1/reports").body_bytes, std::nullopt);
    EXPECT_EQ(m_application->handling("POST", "/nothing").body_bytes, std::nullopt);
}

}  // namespace
}  // namespace sheer::test::uploads_test
