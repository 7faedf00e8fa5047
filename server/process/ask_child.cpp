#include "server/process/ask_child.h"

#include <fmt/format.h>

#include "server/process/memory_file.h"
#include "server/process/run_child.h"

namespace sheer {

namespace {

// Longer than every fragment of a pixel, at some 200 bytes each, and than the FLIP maps of a run.
constexpr std::size_t max_reply_bytes = std::size_t{256} << 20;

}  // namespace

ChildReply ask_child(const std::vector<std::string>& arguments, const std::string& input, const ChildLimits& limits) {
    const MemoryFile file("question", input);
    ChildReply reply;
    ChildRun run;
    run.options.program = limits.program;
    run.options.fork_server = limits.fork_server;
    run.options.arguments = arguments;
    confine(run.options, limits.sandbox);
    run.options.memory_limit_bytes = limits.memory_bytes;
    run.options.input = file.descriptor();
    run.time_limit = limits.time;
    run.max_line_bytes = max_reply_bytes;
    run.on_line = [&reply](const std::string& line) { reply.line = line; };
    const ChildResult result = run_child(run);
    reply.status = result.status;
    reply.timed_out = result.timed_out;
    return reply;
}

std::string ending_text(const std::string& command, const ExitStatus& status) {
    return fmt::format("sheer {} ended with exit code {}, signal {}", command, status.code, status.signal);
}

}  // namespace sheer
