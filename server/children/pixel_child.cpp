#include "server/children/pixel_child.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "renderer/core/exit_codes.h"
#include "server/jobs/foreign_input.h"
#include "server/process/child_message.h"

namespace sheer {

PixelAnswer run_pixel_child(const std::string& report, const PixelPlace& place, const PixelFolders& folders,
                            const ChildLimits& limits) {
    std::vector<std::string> arguments = {"pixel",
                                          "/dev/stdin",
                                          "--json",
                                          "--data",
                                          folders.data.string(),
                                          fmt::format("--x={}", place.x),
                                          fmt::format("--y={}", place.y),
                                          fmt::format("--run={}", place.run)};
    if (!has_foreign_input(nlohmann::json::parse(report).at("spec")))
        arguments.insert(arguments.end(), {"--shaders", folders.shaders.string()});
    const ChildReply reply = ask_child(arguments, report, limits);
    if (reply.timed_out)
        return {.refusal = fmt::format("Explaining the pixel takes longer than {} s.",
                                       std::chrono::duration<double>(limits.time).count()),
                .too_slow = true};
    if (reply.status.code == exit_ok && reply.line.starts_with('{')) return {.json = reply.line};
    const ChildMessage message = read_child_message(reply.line);
    const auto* error = std::get_if<ChildError>(&message);
    if (error && reply.status.code == exit_bad_spec)
        return {.refusal = fmt::format("The report cannot be rendered again here: {}", error->error.detail)};
    throw std::runtime_error(
        fmt::format("{}: {}", ending_text("pixel", reply.status), error ? error->error.detail : "no message"));
}

}  // namespace sheer
