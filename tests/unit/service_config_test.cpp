#include "server/cli/service_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "renderer/core/errors.h"
#include "server/http/server.h"
#include "temporary_folder.h"
#include "tests/source_folder.h"

namespace sheer::cli::service_config_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

std::vector<std::string> wrong_fields(const json& document) {
    std::vector<std::string> pointers;
    try {
        read_service_config(document);
    } catch (const SpecError& error) {
        for (const FieldError& field : error.errors()) pointers.push_back(field.pointer);
    }
    return pointers;
}

TEST(ServiceConfigTest, EverythingHasADefault) {
    const ServiceConfig config = read_service_config(json::object());
    EXPECT_EQ(config.listen, "127.0.0.1:8080");
    EXPECT_EQ(config.workers, 1);
    EXPECT_EQ(config.http.body_bytes, 1u << 20);
    EXPECT_EQ(config.leases.lease_ms, 10'000);
    EXPECT_EQ(config.leases.max_attempts, 2);
    EXPECT_EQ(config.worker.time_limit, std::chrono::minutes(30));
}

TEST(ServiceConfigTest, TheShippedFileHasTheDefaults) {
    std::ifstream file(std::string(source_folder()) + "/configs/server.json");
    const json shipped = json::parse(file);
    std::vector<FieldError> none;
    EXPECT_EQ(shipped, read_fields(json::object(), "", service_config_fields(), none));
}

TEST(ServiceConfigTest, EveryFieldHasItsOwnPlace) {
    const ServiceConfig config = read_service_config(json::parse(R"({
        "listen": "[::1]:1", "data": "d", "workers": 2, "log_level": "error",
        "http": {"max_connections": 3, "max_streams_per_client": 4, "threads": 10, "header_bytes": 1025, "body_bytes": 1026,
                 "drain_bytes": 7, "spool_bytes": 2000000, "idle_timeout_s": 8, "header_timeout_s": 9, "body_timeout_s": 10.5,
                 "write_timeout_s": 11, "event_heartbeat_s": 12, "stop_timeout_s": 13, "max_wait_s": 14,
                 "ready_within_s": 15, "devices_cache_s": 16},
        "jobs": {"max_queued": 17, "max_queued_cost": 18000, "lease_s": 19, "heartbeat_s": 18, "max_attempts": 5},
        "assets": {"max_bytes": 1027, "check_memory_bytes": 21, "check_time_s": 22},
        "worker": {"memory_limit_bytes": 23, "output_limit_bytes": 22, "time_limit_s": 24, "pixel_time_limit_s": 25, "poll_s": 0.25,
                   "probe_interval_s": 27}})"));
    const http::Limits& http = config.http;
    EXPECT_EQ(config.listen, "[::1]:1");
    EXPECT_EQ(config.data, "d");
    EXPECT_EQ(config.workers, 2);
    EXPECT_EQ(config.log_level, "error");
    EXPECT_EQ(http.max_connections, 3);
    EXPECT_EQ(http.max_streams_per_client, 4);
    EXPECT_EQ(http.threads, 10);
    EXPECT_EQ(http.header_bytes, 1025u);
    EXPECT_EQ(http.body_bytes, 1026u);
    EXPECT_EQ(http.drain_bytes, 7u);
    EXPECT_EQ(http.spool_bytes, 2'000'000u);
    EXPECT_EQ(http.idle_timeout, 8s);
    EXPECT_EQ(http.header_timeout, 9s);
    EXPECT_EQ(http.body_timeout, 10'500ms);
    EXPECT_EQ(http.write_timeout, 11s);
    EXPECT_EQ(http.event_heartbeat, 12s);
    EXPECT_EQ(http.stop_timeout, 13s);
    EXPECT_EQ(config.answers.max_wait, 14s);
    EXPECT_EQ(config.answers.ready_within, 15s);
    EXPECT_EQ(config.devices_cache, 16s);
    EXPECT_EQ(config.answers.max_queued, 17u);
    EXPECT_EQ(config.answers.max_queued_cost, 18'000);
    EXPECT_EQ(config.answers.max_checks, 5);
    EXPECT_EQ(config.answers.max_diffs, 5);
    EXPECT_EQ(config.leases.heartbeat_ms, 18'000);
    EXPECT_EQ(config.leases.lease_ms, 19'000);
    EXPECT_EQ(config.leases.max_attempts, 5);
    EXPECT_EQ(config.worker.rules.lease_ms, 19'000);
    EXPECT_EQ(config.answers.max_asset_bytes, 1027u);
    EXPECT_EQ(config.upload_check.memory_bytes, 21u);
    EXPECT_EQ(config.upload_check.time, 22s);
    EXPECT_EQ(config.worker.memory_limit_bytes, 23u);
    EXPECT_EQ(config.worker.output_limit_bytes, 22u);
    EXPECT_EQ(config.question.memory_bytes, 23u);
    EXPECT_EQ(config.worker.time_limit, 24s);
    EXPECT_EQ(config.question.time, 25s);
    EXPECT_EQ(config.worker.poll_interval, 250ms);
    EXPECT_EQ(config.worker.probe_interval, 27s);
}

TEST(ServiceConfigTest, TheCommandLineOverridesTheFile) {
    const test::TemporaryFolder folder;
    const auto file = folder.file("server.json", R"({"workers": 3, "listen": "[::1]:1"})");
    const ServiceConfig config = load_service_config(file, {{"workers", 0}});
    EXPECT_EQ(config.workers, 0);
    EXPECT_EQ(config.listen, "[::1]:1");
    EXPECT_EQ(load_service_config("", {{"data", "d"}}).data, "d");
    EXPECT_THROW(load_service_config(file, {{"workers", 257}}), SpecError);
    EXPECT_THROW(load_service_config(folder.file("list.json", "[]"), {{"workers", 1}}), SpecError);
}

TEST(ServiceConfigTest, SecondsAreRead) {
    const ServiceConfig config = read_service_config({{"jobs", {{"lease_s", 2.5}, {"heartbeat_s", 0.1}}},
                                                      {"worker", {{"time_limit_s", 3}}},
                                                      {"allowed_hosts", {"a.b"}}});
    EXPECT_EQ(config.leases.lease_ms, 2'500);
    EXPECT_EQ(config.worker.rules.heartbeat_ms, 100);
    EXPECT_EQ(config.worker.time_limit, std::chrono::seconds(3));
    EXPECT_TRUE(config.allowed_hosts.contains("a.b"));
}

TEST(ServiceConfigTest, EveryWrongFieldIsNamed) {
    EXPECT_THAT(wrong_fields({{"lisen", "x"}, {"workers", -1}, {"http", {{"threads", "four"}, {"odd", 1}}}}),
                testing::UnorderedElementsAre("/lisen", "/workers", "/http/threads", "/http/odd"));
    EXPECT_THAT(wrong_fields({{"allowed_hosts", {"a", 1}}}), testing::ElementsAre("/allowed_hosts/1"));
    EXPECT_THAT(wrong_fields({{"allowed_hosts", "a"}}), testing::ElementsAre("/allowed_hosts"));
    EXPECT_THAT(wrong_fields({{"jobs", {{"lease_s", 1}, {"heartbeat_s", 1}}}}), testing::ElementsAre("/jobs/lease_s"));
    EXPECT_THAT(wrong_fields(json::array()), testing::ElementsAre(""));
}

TEST(ServiceConfigTest, AFileThatCannotBeReadIsAnError) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(load_service_config(folder.path() / "none.json"), SpecError);
    EXPECT_THROW(load_service_config(folder.file("bad.json", "{")), SpecError);
}

TEST(EndpointTest, AddressesAndPorts) {
    EXPECT_EQ(http::parse_endpoint("127.0.0.1:0").port, 0);
    EXPECT_EQ(http::parse_endpoint("[::1]:65535").address, "::1");
    EXPECT_EQ(http::parse_endpoint("localhost:80").address, "127.0.0.1");
    EXPECT_EQ(http::url_of(http::parse_endpoint("[::1]:80")), "http://[::1]:80");
    EXPECT_TRUE(http::is_loopback(http::parse_endpoint("127.1.2.3:80")));
    EXPECT_TRUE(http::is_loopback(http::parse_endpoint("[::1]:80")));
    EXPECT_FALSE(http::is_loopback(http::parse_endpoint("0.0.0.0:80")));
    for (const char* bad :
         {"", "8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:80x", "name:80", ":80"})
        EXPECT_THROW(http::parse_endpoint(bad), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace sheer::cli::service_config_test
