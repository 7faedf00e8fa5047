#include "server/cli/service_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/errors.h"
#include "server/http/server.h"
#include "temporary_folder.h"

namespace sheer::cli::service_config_test {
namespace {

using nlohmann::json;

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

TEST(ServiceConfigTest, TheShippedFileSaysTheDefaults) {
    const ServiceConfig shipped = load_service_config(SHEER_SOURCE_DIR "/configs/server.json");
    const ServiceConfig defaults = load_service_config("");
    EXPECT_EQ(shipped.listen, defaults.listen);
    EXPECT_EQ(shipped.http.max_connections, defaults.http.max_connections);
    EXPECT_EQ(shipped.http.drain_bytes, defaults.http.drain_bytes);
    EXPECT_EQ(shipped.http.event_heartbeat, defaults.http.event_heartbeat);
    EXPECT_EQ(shipped.max_queued, defaults.max_queued);
    EXPECT_EQ(shipped.leases.heartbeat_ms, defaults.leases.heartbeat_ms);
    EXPECT_EQ(shipped.max_asset_bytes, defaults.max_asset_bytes);
    EXPECT_EQ(shipped.upload_check.memory_limit_bytes, defaults.upload_check.memory_limit_bytes);
    EXPECT_EQ(shipped.upload_check.time_limit, defaults.upload_check.time_limit);
    EXPECT_EQ(shipped.worker.memory_limit_bytes, defaults.worker.memory_limit_bytes);
    EXPECT_EQ(shipped.pixel_time_limit, defaults.pixel_time_limit);
    EXPECT_EQ(shipped.worker.poll_interval, defaults.worker.poll_interval);
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
