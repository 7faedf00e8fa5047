#pragma once
#include <chrono>
#include <cstdint>

namespace sheer::http {

// The fields of the configuration describe each limit and its range: server/cli/service_config.cpp.

/// What one connection may use, and how many connections there may be.
struct Limits {
    int max_connections = 256;
    int max_streams_per_client = 64;
    int threads = 4;
    std::uint32_t header_bytes = 16 << 10;
    std::uint64_t body_bytes = 1 << 20;
    std::uint64_t drain_bytes = 64 << 20;
    std::uint64_t spool_bytes = 1 << 30;
    std::chrono::milliseconds idle_timeout{60'000};
    std::chrono::milliseconds header_timeout{10'000};
    std::chrono::milliseconds body_timeout{30'000};
    std::chrono::milliseconds write_timeout{30'000};
    std::chrono::milliseconds event_heartbeat{15'000};
    std::chrono::milliseconds stop_timeout{5'000};
};

/// What one comparison may ask for, besides the limits that every spec has.
struct JobLimits {
    std::int64_t max_pixels = 4096 * 4096;  ///< of one picture
    std::int64_t max_methods = 64;
    std::int64_t max_points = 256;  ///< of its sweep
    std::int64_t max_cost = 1'000'000'000;
};

/// What one request may ask for.
struct AnswerLimits {
    std::size_t max_queued = 100;
    std::int64_t max_queued_cost = 4'000'000'000;
    JobLimits job;
    std::uint64_t max_asset_bytes = 64 << 20;
    std::chrono::seconds max_wait{300};
    std::chrono::seconds ready_within{90};
    int max_checks = 2;  ///< uploads that are read at the same time
    int max_diffs = 2;   ///< diffs of reports that are made at the same time
};

}  // namespace sheer::http
