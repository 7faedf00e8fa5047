// Uploaded files on the service's side: the child that reads them, the store that keeps them, the calls.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <utility>

#include "server/http/application.h"
#include "server/http/service.h"
#include "server/worker/upload_check.h"
#include "store_fixture.h"

namespace sheer::test::uploads_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace std::chrono_literals;

class UploadCheckTest : public testing::Test {
  protected:
    /// $1 is check-asset, $2 the file, $3 --type, $4 the media type.
    UploadVerdict check_with(const std::string& script, const std::string& bytes = "bytes",
                             std::chrono::milliseconds time_limit = 20s) {
        UploadCheckOptions options{.memory_limit_bytes = 0, .time_limit = time_limit};
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

TEST_F(UploadCheckTest, WhateverElseHappensIsARefusal) {
    EXPECT_EQ(check_with(R"(echo '{"refusal": "it is green"}')").refusal, "it is green");
    EXPECT_THAT(check_with("kill -SEGV $$").refusal, HasSubstr("dies of it"));
    EXPECT_THAT(check_with(R"(echo '{"facts": {}}'; exit 3)").refusal, HasSubstr("dies of it"));
    EXPECT_THAT(check_with("sleep 60", "", 50ms).refusal, HasSubstr("longer than 0.05 s"));
    for (const char* line : {"", "[]", "{", R"({"facts": 1})", R"({"refusal": {}})"})
        EXPECT_THAT(check_with("echo '" + std::string(line) + "'").refusal, HasSubstr("nothing that can be understood"))
            << line;
}

class AssetStoreTest : public StoreTest {
  protected:
    std::string add(const std::string& bytes, const std::string& type = "texture") {
        m_now_ms += 1;
        const std::string sha256 = sha256_hex(bytes);
        m_store.add_asset({.sha256 = sha256,
                           .type = type,
                           .media_type = "image/png",
                           .name = "name of " + bytes,
                           .size_bytes = static_cast<std::int64_t>(bytes.size()),
                           .facts = {{"width", 7}}},
                          bytes);
        return sha256;
    }

    std::vector<std::string> names() {
        std::vector<std::string> all;
        for (const Asset& asset : m_store.list_assets(2)) all.push_back(asset.name);
        return all;
    }

    const std::filesystem::path m_files = m_folder.path() / "data" / "assets";
};

TEST_F(AssetStoreTest, AnAssetIsKeptOnceWithItsBytes) {
    const std::string sha256 = add("first");
    const std::int64_t created_ms = m_now_ms;
    add("first");
    const auto asset = m_store.find_asset(sha256);
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->type, "texture");
    EXPECT_EQ(asset->media_type, "image/png");
    EXPECT_EQ(asset->size_bytes, 5);
    EXPECT_EQ(asset->created_ms, created_ms);
    EXPECT_EQ(asset->facts, (json{{"width", 7}}));
    EXPECT_EQ(read_file(asset->path, 100), "first");
    EXPECT_EQ(TemporaryFolder::count_files(m_files), 1);
    EXPECT_FALSE(m_store.find_asset(sha256_hex("other")));
    EXPECT_FALSE(m_store.find_blob(sha256));
}

TEST_F(AssetStoreTest, TheListIsNewestFirst) {
    for (const char* bytes : {"a", "b", "c"}) add(bytes);
    EXPECT_THAT(names(), ElementsAre("name of c", "name of b"));
}

TEST_F(AssetStoreTest, OnlyAnAssetThatNobodyWaitsForIsRemoved) {
    const std::string sha256 = add("first"), other = add("second");
    const std::string id = submit("title", {{"scene", {{"type", "quads"}, {"texture", {{"image", sha256}}}}}});
    EXPECT_EQ(m_store.remove_asset(sha256), RemoveAssetResult::in_use);
    const Lease job = lease();
    EXPECT_EQ(m_store.remove_asset(sha256), RemoveAssetResult::in_use);
    EXPECT_EQ(m_store.remove_asset(other), RemoveAssetResult::removed);
    EXPECT_TRUE(m_store.commit(job, finished(job, "picture")));
    EXPECT_EQ(m_store.remove_asset(sha256), RemoveAssetResult::removed);
    EXPECT_EQ(m_store.remove_asset(sha256), RemoveAssetResult::not_found);
    EXPECT_EQ(TemporaryFolder::count_files(m_files), 0);
    EXPECT_EQ(status(id), Status::done);
}

TEST_F(AssetStoreTest, DeletingReportsLeavesAssetsAlone) {
    const std::string sha256 = add("picture");
    const std::string id = make_done("title", "picture");
    EXPECT_EQ(m_store.remove(id), RemoveResult::deleted);
    EXPECT_FALSE(m_store.find_blob(sha256));
    EXPECT_EQ(read_file(m_store.find_asset(sha256)->path, 100), "picture");
}

TEST_F(AssetStoreTest, AnArchiveOfVersionOneIsBroughtUpToDate) {
    const std::string id = submit("kept");
    {
        SQLite::Database database((m_folder.path() / "data" / "archive.sqlite").string(), SQLite::OPEN_READWRITE);
        database.exec("DROP TABLE assets; DROP INDEX reports_that_died; DROP INDEX reports_set_back");
        for (const char* column : {"setbacks", "not_before_ms", "lacks_room", "died_of"})
            database.exec(std::string("ALTER TABLE reports DROP COLUMN ") + column);
        database.exec("PRAGMA user_version = 1; PRAGMA application_id = 0");
    }
    SqliteStore again(m_folder.path() / "data", m_rules, m_clock);
    EXPECT_TRUE(again.find(id));
    EXPECT_TRUE(again.list_assets(1).empty());
    EXPECT_TRUE(again.lease("worker"));
}

class AssetCallsTest : public AssetStoreTest {
  protected:
    AssetCallsTest() {
        m_service.clock = m_clock;
        m_service.check_upload = [this](const std::string&, const std::string&) {
            if (const auto action = std::exchange(m_while_checking, nullptr)) action();
            return UploadVerdict{"", json::object()};
        };
        m_service.max_checks = 1;
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
    const std::string model = add("bytes", "model");
    const json spec = {{"scene", {{"type", "quads"}, {"texture", {{"image", model}}}}}, {"methods", {"b2f"}}};
    const http::Response response = post("/api/v1/reports", "application/json", spec.dump());
    EXPECT_EQ(response.status, 422);
    const json error = json::parse(std::get<std::string>(response.body))["errors"][0];
    EXPECT_EQ(error["pointer"], "/scene/texture/image");
    EXPECT_THAT(error["detail"].get<std::string>(), HasSubstr("is a model (image/png), not a texture"));
    EXPECT_TRUE(m_store.list({}).reports.empty());
}

TEST_F(AssetCallsTest, TheSameBytesHaveOneType) {
    EXPECT_EQ(post("/api/v1/assets", "image/png", "bytes").status, 201);
    EXPECT_EQ(post("/api/v1/assets", "image/png", "bytes").status, 200);
    const http::Response other = post("/api/v1/assets", "image/jpeg", "bytes");
    EXPECT_EQ(other.status, 409);
    EXPECT_THAT(detail(other), HasSubstr("as image/png"));
}

TEST_F(AssetCallsTest, OnlySoManyAreReadAtATime) {
    http::Response second;
    m_while_checking = [&] { second = post("/api/v1/assets", "image/png", "second"); };
    EXPECT_EQ(post("/api/v1/assets", "image/png", "first").status, 201);
    EXPECT_EQ(second.status, 429);
    EXPECT_TRUE(second.headers.contains("Retry-After"));
    EXPECT_EQ(post("/api/v1/assets", "image/png", "second").status, 201);
}

TEST_F(AssetCallsTest, TheLimitOfUploadsIsTheirOwn) {
    m_service.max_asset_bytes = 12345;
    m_application.emplace(http::make_guard(true, {}), http::make_router(m_service));
    EXPECT_EQ(m_application->handling("POST", "/api/v1/assets?name=a").body_bytes, 12345u);
    EXPECT_EQ(m_application->handling("GET", "/api/v1/assets").body_bytes, std::nullopt);
    EXPECT_EQ(m_application->handling("POST", "/api/v1/reports").body_bytes, std::nullopt);
    EXPECT_EQ(m_application->handling("POST", "/nothing").body_bytes, std::nullopt);
}

}  // namespace
}  // namespace sheer::test::uploads_test
