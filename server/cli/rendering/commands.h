#pragma once
#include <CLI/CLI.hpp>

#include "renderer/command/command.h"

namespace sheer::cli {

// Each adds its subcommand to `app`; if it is chosen, it runs and stores the exit code.
void add_compare(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);
void add_devices(CLI::App& app, int& exit_code);
void add_diff(CLI::App& app, int& exit_code);
void add_docs(CLI::App& app, int& exit_code);     ///< for ./dev docs; not shown in the help
void add_gallery(CLI::App& app, int& exit_code);  ///< hidden: see ./dev gallery
void add_litmus(CLI::App& app, int& exit_code);
void add_manual(CLI::App& app, int& exit_code);  ///< for packages; not shown in the help
void add_pixel(CLI::App& app, int& exit_code);
void add_qualify(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);

// Child processes of the service and its workers, not shown in the help.
void add_check_asset(CLI::App& app, int& exit_code);
void add_check_shading(CLI::App& app, int& exit_code);
void add_diff_stored(CLI::App& app, int& exit_code);
void add_against_stored(CLI::App& app, int& exit_code);
void add_join_stored(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);

/// All of them: the commands that draw or decode pictures.
void add_rendering_commands(CLI::App& app, int& exit_code);

}  // namespace sheer::cli
