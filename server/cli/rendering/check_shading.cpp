// The service's child process that compiles one shading, as drivers may crash on what they compile. It reads the GLSL
// from its standard input and prints a JSON object.
#include <fmt/format.h>

#include "renderer/compare/shading_check.h"
#include "renderer/core/files.h"
#include "renderer/params/json_text.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"
#include "server/cli/rendering/sandbox_option.h"

namespace sheer::cli {

void add_check_shading(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("check-shading", "Compile one shading for the service")->group("");
    auto request = std::make_shared<gl::ContextRequest>();
    add_context_options(*command, *request);
    auto sandbox = std::make_shared<SandboxOption>();
    sandbox->add_to(*command);
    command->callback([request, sandbox, &exit_code] {
        try {
            sandbox->confine_files({});
            const auto context = gl::open_device(*request);
            sandbox->confine_calls();
            const std::string glsl = read_file("/dev/stdin");
            fmt::print("{}\n", json_line({{"messages", compile_shading(*context, glsl)}}));
            exit_code = exit_ok;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer check-shading: {}\n", error.what());
            exit_code = exit_render_failed;
        }
    });
}

}  // namespace sheer::cli
