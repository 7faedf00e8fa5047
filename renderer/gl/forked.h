#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace sheer::gl {

/// Sends a line, without its end, from the child to its parent.
using Say = std::function<void(const std::string& line)>;

/// The outcome of a child.
struct ForkedRun {
    std::vector<std::string> lines;  ///< what it said
    std::string trouble;             ///< how it ended before its work was done: "crashed (signal 11)"; otherwise ""
};

/// Does `work` in a copy of this process, which may crash or hang without harming this one. What the copy prints is
/// discarded, and no destructor of this process's objects runs in it. Only the calling thread exists in the copy, and
/// drivers do not expect to be copied: call it before OpenGL and before there are threads that hold locks. Throws
/// std::system_error.
ForkedRun run_forked(const std::function<void(const Say& say)>& work, std::chrono::milliseconds time_limit);

}  // namespace sheer::gl
