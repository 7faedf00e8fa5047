#pragma once
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/worker/child_process.h"

namespace sheer {

/// What `sheer devices --json` says. It runs in a child, since asking drivers can take a process down, and the answer
/// is kept for a while. Safe to share by threads.
class DeviceList {
  public:
    explicit DeviceList(std::chrono::milliseconds keep, std::string program = own_program);
    /// Throws std::runtime_error if the child fails.
    nlohmann::json get();

  private:
    nlohmann::json ask() const;

    std::chrono::milliseconds m_keep;
    std::string m_program;
    std::mutex m_mutex;
    std::optional<nlohmann::json> m_known;
    std::chrono::steady_clock::time_point m_known_since{};
};

}  // namespace sheer
