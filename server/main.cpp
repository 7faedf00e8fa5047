#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "server/cli/commands.h"
#include "version.h"

int main(int argc, char** argv) {
    // The log goes to stderr, so that stdout is the commands' own; SPDLOG_LEVEL=info says more.
    spdlog::set_default_logger(spdlog::stderr_color_mt("sheer"));
    spdlog::set_level(spdlog::level::warn);
    spdlog::cfg::load_env_levels();

    CLI::App app{"Sheer compares transparency methods: images, timings and differences of a scene, as a report."};
    app.set_version_flag("--version", std::string("sheer ") + sheer::version + " (" + sheer::commit + ")");
    app.require_subcommand(1);
    int exit_code = sheer::cli::exit_ok;
    sheer::cli::add_compare(app, exit_code);
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
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? sheer::cli::exit_ok : sheer::cli::exit_bad_spec;
    }
    return exit_code;
}
