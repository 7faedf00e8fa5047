#pragma once
#include <chrono>
#include <cstdint>

namespace sheer::http {

/// What one connection may take, and how many there may be.
struct Limits {
    int max_connections = 256;
    int max_streams_per_client = 64;  ///< answers to one address that last: events, and requests that wait for a report
    int threads = 4;                  ///< that run handlers
    std::uint32_t header_bytes = 16 << 10;
    std::uint64_t body_bytes = 1 << 20;
    std::uint64_t drain_bytes =
        64 << 20;  ///< of a body over the limit, read and dropped so that its sender sees the answer
    std::chrono::milliseconds idle_timeout{60'000};     ///< between requests
    std::chrono::milliseconds header_timeout{10'000};   ///< from the first byte of a request to the end of its header
    std::chrono::milliseconds body_timeout{30'000};     ///< for the whole body
    std::chrono::milliseconds write_timeout{30'000};    ///< for the reader to take a piece of the answer
    std::chrono::milliseconds event_heartbeat{15'000};  ///< between two signs of life in a stream of events
    std::chrono::milliseconds stop_timeout{5'000};      ///< for answers that are on their way when the service stops
};

}  // namespace sheer::http
