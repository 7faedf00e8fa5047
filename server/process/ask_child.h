#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/process/child_process.h"
#include "server/process/rendering_program.h"
#include "server/process/sandbox_settings.h"

namespace sheer {

/// The limits of a child that answers one question.
struct ChildLimits {
    std::uint64_t memory_bytes = 0;  ///< address space; 0: no limit
    std::chrono::milliseconds time{60'000};
    std::string program = rendering_program();
    SandboxSettings sandbox{.enabled = false};
    std::shared_ptr<ForkServer> fork_server = nullptr;  ///< of `program`, if any
};

struct ChildReply {
    std::string line;  ///< the last one that it printed
    ExitStatus status;
    bool timed_out = false;
};

/// Runs a child that may die; `input`, which is a file that is only in memory, is its standard input. Throws
/// std::system_error if it cannot be started.
ChildReply ask_child(const std::vector<std::string>& arguments, const std::string& input, const ChildLimits& limits);

/// "sheer pixel ended with exit code 3, signal 0", for the log.
std::string ending_text(const std::string& command, const ExitStatus& status);

}  // namespace sheer
