// All commands, with the libraries that draw and decode pictures.
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "server/cli/commands.h"
#include "server/cli/rendering/commands.h"
#include "server/process/fork_server.h"

namespace {

int run(int argc, char** argv) {
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

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argv[1] != std::string_view(sheer::fork_server_command)) return run(argc, argv);
    std::vector<std::string> words = sheer::serve_forks(STDIN_FILENO, argc, argv);
    std::vector<char*> pointers{argv[0]};
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int code = run(static_cast<int>(pointers.size()) - 1, pointers.data());
    std::cout.flush();
    std::fflush(nullptr);
    _exit(code);
}
