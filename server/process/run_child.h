#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "server/process/child_process.h"

namespace sheer {

/// How a child ended.
struct ChildResult {
    ExitStatus status;
    bool timed_out = false;  ///< it was killed at the limit
    bool stopped = false;    ///< it was killed because `keep_going` said so
};

struct ChildRun {
    ChildOptions options;
    std::chrono::milliseconds time_limit{};
    std::size_t max_line_bytes = 1 << 16;
    int wake_descriptor = -1;  ///< readable when `keep_going` should be called at once
    std::function<void(const std::string& line)> on_line;
    std::function<bool()> keep_going;  ///< called every 100 ms or sooner; false kills the child
};

/// Runs a child, passes on its lines of output and waits for its end. If one of the two functions throws, kills the
/// child and rethrows. Throws std::system_error if the child cannot be started.
ChildResult run_child(const ChildRun& run);

}  // namespace sheer
