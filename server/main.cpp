#include <fmt/format.h>
#include <unistd.h>

#include <cstring>

#include "server/cli/commands.h"
#include "server/process/rendering_program.h"

namespace {

/// Continues as the program that has all commands. It takes as long to load as this one takes to do its work.
int become_rendering_program(char** argv) {
    const std::string program = sheer::rendering_program();
    execv(program.c_str(), argv);
    fmt::print(stderr, "sheer: cannot start {}: {}\n", program, std::strerror(errno));
    return sheer::exit_bad_spec;
}

}  // namespace

int main(int argc, char** argv) {
    sheer::cli::log_to_stderr("sheer");
    CLI::App app{"", "sheer"};
    app.require_subcommand(1);
    int exit_code = sheer::exit_ok;
    sheer::cli::add_service_commands(app, exit_code);
    const auto is_asked_for = [&](const CLI::App* command) { return argc > 1 && command->check_name(argv[1]); };
    if (app.get_subcommands(is_asked_for).empty()) return become_rendering_program(argv);
    return sheer::cli::run_command_line(app, argc, argv, exit_code, [&](const std::string& message) {
        sheer::cli::note_wrong_command_line(argc, argv, message);
    });
}
