#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace sheer::cli {

/// The command that was chosen on the command line, and its name with those above it, such as "sheer baseline accept".
struct ChosenCommand {
    const CLI::App* app = nullptr;
    std::string name;
};
ChosenCommand chosen_command(const CLI::App& app);

/// The commands of `app` that its help shows, and its options with their dashes.
std::vector<std::string> shown_commands(const CLI::App& app);
std::vector<std::string> option_names(const CLI::App& app);

/// What is wrong with a command line that `app` could not read, with what was probably meant.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error);

}  // namespace sheer::cli
