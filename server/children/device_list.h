#pragma once
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/process/child_process.h"
#include "server/process/rendering_program.h"

namespace sheer {

/// The output of `sheer devices --json`. It runs in a child, since drivers may crash the process that queries them, and
/// the answer is cached for a while. Thread-safe.
class DeviceList {
  public:
    explicit DeviceList(std::chrono::milliseconds keep, std::string program = rendering_program());
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
