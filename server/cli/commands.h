#pragma once
#include <CLI/CLI.hpp>

#include "renderer/command/command.h"

namespace sheer::cli {

// Each adds its subcommand to `app`; if it is chosen, it runs and stores the exit code.
void add_archive(CLI::App& app, int& exit_code);  ///< the care of an archive
void add_baseline(CLI::App& app, int& exit_code);
void add_catalog(CLI::App& app, int& exit_code);  ///< methods, scenes, metrics, suites
void add_serve(CLI::App& app, int& exit_code);
void add_submit(CLI::App& app, int& exit_code);
void add_token(CLI::App& app, int& exit_code);
void add_worker(CLI::App& app, int& exit_code);  ///< started by serve; not shown in the help

/// All of them: the commands that need neither OpenGL nor a picture library.
void add_service_commands(CLI::App& app, int& exit_code);

/// For a command line that cannot be read: writes the JUnit file that it requests.
void note_wrong_command_line(int argc, const char* const* argv, const std::string& message);

}  // namespace sheer::cli
