#include "server/children/pixel_child.h"

#include <fmt/format.h>

#include <stdexcept>

#include "renderer/core/exit_codes.h"
#include "server/process/child_message.h"
#include "server/process/memory_file.h"
#include "server/process/run_child.h"

namespace sheer {

namespace {

// A line holds every fragment of the pixel, some 200 bytes each.
constexpr std::size_t max_line_bytes = std::size_t{128} << 20;

ChildRun child_run(const PixelPlace& place, const PixelOptions& options, int input) {
    ChildRun run;
    run.options.program = options.program;
    run.options.arguments = {"pixel",
                             "/dev/stdin",
                             "--json",
                             "--data",
                             options.data.string(),
                             fmt::format("--x={}", place.x),
                             fmt::format("--y={}", place.y),
                             fmt::format("--run={}", place.run)};
    run.options.memory_limit_bytes = options.memory_limit_bytes;
    run.options.input = input;
    run.time_limit = options.time_limit;
    run.max_line_bytes = max_line_bytes;
    return run;
}

}  // namespace

PixelAnswer run_pixel_child(const std::string& report, const PixelPlace& place, const PixelOptions& options) {
    const MemoryFile file("report", report);
    std::string line;
    ChildRun run = child_run(place, options, file.descriptor());
    run.on_line = [&line](const std::string& text) { line = text; };
    const ChildResult result = run_child(run);
    if (result.timed_out)
        return {.refusal = fmt::format("Explaining the pixel takes longer than {} s.",
                                       std::chrono::duration<double>(options.time_limit).count()),
                .too_slow = true};
    if (result.status.code == exit_ok && line.starts_with('{')) return {.json = line};
    const ChildMessage message = read_child_message(line);
    const auto* error = std::get_if<ChildError>(&message);
    if (error && result.status.code == exit_bad_spec)
        return {.refusal = fmt::format("The report cannot be rendered again here: {}", error->error.detail)};
    throw std::runtime_error(fmt::format("sheer pixel ended with exit code {}, signal {}: {}", result.status.code,
                                         result.status.signal, error ? error->error.detail : "no message"));
}

}  // namespace sheer
