#pragma once
#include <CLI/CLI.hpp>

#include "renderer/command/command.h"

namespace sheer::cli {

/// Each adds its subcommand to `app`; if it is chosen, it runs and stores the exit code.
void add_compare(CLI::App& app, int& exit_code);
/// For a command line that cannot be read: writes the JUnit file that it requests.
void note_wrong_command_line(int argc, const char* const* argv, const std::string& message);
void add_baseline(CLI::App& app, int& exit_code);
void add_catalog(CLI::App& app, int& exit_code);  ///< methods, scenes, devices
void add_diff(CLI::App& app, int& exit_code);
void add_docs(CLI::App& app, int& exit_code);     ///< for ./dev docs; not shown in the help
void add_gallery(CLI::App& app, int& exit_code);  ///< hidden: see ./dev gallery
void add_pixel(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);         ///< the worker's child process; not shown in the help
void add_check_asset(CLI::App& app, int& exit_code);    ///< the service's child process; not shown in the help
void add_check_shading(CLI::App& app, int& exit_code);  ///< likewise
void add_serve(CLI::App& app, int& exit_code);
void add_submit(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_worker(CLI::App& app, int& exit_code);  ///< started by serve; not shown in the help

}  // namespace sheer::cli
