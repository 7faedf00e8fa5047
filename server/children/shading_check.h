#pragma once
#include <chrono>
#include <list>
#include <mutex>
#include <string>
#include <utility>

#include "server/process/ask_child.h"

namespace sheer {

struct ShadingCheckOptions {
    ChildLimits child{.time = std::chrono::seconds(10)};
    std::chrono::milliseconds longest_wait{5'000};  ///< for another check to end
    std::size_t kept = 1024;                        ///< answers that are remembered
};

/// Compiles the users' own shadings before a job is queued, in a child that may die, and remembers the answers by the
/// SHA-256 of the GLSL. Thread-safe.
class ShadingCheck {
  public:
    explicit ShadingCheck(ShadingCheckOptions options) : m_options(std::move(options)) {}

    /// What is wrong with this body, with the user's lines; "" if nothing is, or if that cannot be found out: the
    /// child died, took too long, or another check does. Then rendering will tell.
    std::string messages(const std::string& glsl);
    /// How many children have been started.
    std::size_t compiled();

  private:
    std::string compile(const std::string& glsl, const std::string& key);
    void remember(const std::string& key, const std::string& answer);

    ShadingCheckOptions m_options;
    std::timed_mutex m_child;                                ///< held while a child runs: one at a time
    std::mutex m_mutex;                                      ///< guards what follows
    std::list<std::pair<std::string, std::string>> m_known;  ///< by SHA-256, the one used last first
    std::size_t m_compiled = 0;
};

}  // namespace sheer
