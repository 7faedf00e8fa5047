#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "server/worker/child_process.h"

namespace sheer {

/// How a child ended that was run to its end.
struct ChildResult {
    ExitStatus status;
    bool timed_out = false;  ///< it was killed at the limit
    bool stopped = false;    ///< it was killed because `keep_going` said so
};

struct ChildRun {
    ChildOptions options;
    std::chrono::milliseconds time_limit{};
    std::size_t max_line_bytes = 1 << 16;
    int wake_descriptor = -1;  ///< readable when `keep_going` should be asked at once
    std::function<void(const std::string& line)> on_line;
    std::function<bool()> keep_going;  ///< asked every 100 ms or sooner; false kills the child
};

/// Runs a child, hands on its lines of output and waits for its end. Throws what the two functions throw, with the
/// child killed, and std::system_error if it cannot be started.
ChildResult run_child(const ChildRun& run);

}  // namespace sheer
