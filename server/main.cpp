#include "server/cli/commands.h"

int main(int argc, char** argv) {
    sheer::cli::log_to_stderr("sheer");
    CLI::App app{"Sheer compares transparency methods: images, timings and differences of a scene, as a report.",
                 "sheer"};
    app.require_subcommand(1);
    int exit_code = sheer::exit_ok;
    sheer::cli::add_compare(app, exit_code);
    sheer::cli::add_submit(app, exit_code);
    sheer::cli::add_baseline(app, exit_code);
    sheer::cli::add_diff(app, exit_code);
    sheer::cli::add_pixel(app, exit_code);
    sheer::cli::add_serve(app, exit_code);
    sheer::cli::add_view(app, exit_code);
    sheer::cli::add_catalog(app, exit_code);
    sheer::cli::add_docs(app, exit_code);
    sheer::cli::add_gallery(app, exit_code);
    sheer::cli::add_render(app, exit_code);
    sheer::cli::add_worker(app, exit_code);
    sheer::cli::add_check_asset(app, exit_code);
    sheer::cli::add_check_shading(app, exit_code);
    return sheer::cli::run_command_line(app, argc, argv, exit_code, [&](const std::string& message) {
        sheer::cli::note_wrong_command_line(argc, argv, message);
    });
}
