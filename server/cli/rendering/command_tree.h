#pragma once
#include <string>
#include <vector>

#include "server/cli/commands.h"

namespace sheer::cli {

/// An option of a command, or a word without dashes.
struct OptionEntry {
    std::vector<std::string> names;    ///< with dashes, the long ones first; empty for a word
    std::string value;                 ///< name of its value, "" for none
    std::vector<std::string> choices;  ///< empty for any
    std::string summary;
};

/// A command as the help shows it.
struct CommandEntry {
    std::vector<std::string> words;  ///< such as baseline, accept; empty for the program itself
    std::string summary, footer;
    std::vector<OptionEntry> options, positionals;
    std::vector<std::string> commands;  ///< below it
};

/// The program, then every command that its help shows. Completions and the manual are made from this, so that they
/// say what the parser reads.
std::vector<CommandEntry> command_tree(const CLI::App& app);

/// A script that completes the command line; `shell` is bash, zsh or fish.
std::string completion_script(const std::vector<CommandEntry>& tree, const std::string& shell);

/// A page for man(1), as roff.
std::string manual_page(const std::vector<CommandEntry>& tree);

}  // namespace sheer::cli
