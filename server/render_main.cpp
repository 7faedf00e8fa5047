// All commands, with the libraries that draw and decode pictures.
#include "server/cli/commands.h"
#include "server/cli/rendering/commands.h"

int main(int argc, char** argv) {
    sheer::cli::log_to_stderr("sheer");
    CLI::App app{"Sheer compares transparency methods: images, timings and differences of a scene, as a report.",
                 "sheer"};
    app.require_subcommand(1);
    app.footer("sheer COMMAND --help says more. Example: sheer compare spec.json --out out");
    int exit_code = sheer::exit_ok;
    sheer::cli::add_rendering_commands(app, exit_code);
    sheer::cli::add_service_commands(app, exit_code);
    return sheer::cli::run_command_line(app, argc, argv, exit_code, [&](const std::string& message) {
        sheer::cli::note_wrong_command_line(argc, argv, message);
    });
}
