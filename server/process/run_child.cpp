#include "server/process/run_child.h"

#include "server/process/stop_signal.h"

namespace sheer {

namespace {

constexpr int tick_ms = 100;
// A child ends very soon after the end of its output.
constexpr int ending_tick_ms = 5;

}  // namespace

ChildResult run_child(const ChildRun& run) {
    const auto deadline = std::chrono::steady_clock::now() + run.time_limit;
    ChildProcess child(run.options);
    LineReader lines(run.max_line_bytes);
    bool open = child.output() >= 0;
    while (true) {
        wait_readable({open ? child.output() : -1, run.wake_descriptor}, open ? tick_ms : ending_tick_ms);
        // Checked before its output is read, so that nothing it wrote is missed.
        const std::optional<ExitStatus> ended = child.poll();
        if (open) {
            std::string bytes;
            open = read_available(child.output(), bytes);
            for (const std::string& line : lines.feed(bytes))
                if (run.on_line) run.on_line(line);
        }
        if (ended) return {.status = *ended};
        const bool late = std::chrono::steady_clock::now() >= deadline;
        if (late || (run.keep_going && !run.keep_going())) {
            child.signal(SIGKILL);
            return {.status = child.wait(), .timed_out = late, .stopped = !late};
        }
    }
}

}  // namespace sheer
