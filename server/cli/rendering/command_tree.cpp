#include "server/cli/rendering/command_tree.h"

#include <algorithm>

namespace sheer::cli {

namespace {

/// CLI11 keeps the words that an option allows only as a part of the name of its type: "TEXT:{auto,egl}".
std::vector<std::string> choices_of(const std::string& type) {
    std::vector<std::string> choices;
    const std::size_t begin = type.find('{'), end = type.find('}');
    if (begin == std::string::npos || end == std::string::npos) return choices;
    std::string list = type.substr(begin + 1, end - begin - 1);
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        choices.push_back(list.substr(at, comma - at));
        at = comma + 1;
    }
    return choices;
}

OptionEntry entry_of(const CLI::Option& option) {
    OptionEntry entry{.names = {}, .value = "", .choices = {}, .summary = option.get_description()};
    for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
    const std::string type = option.get_type_name();
    if (option.get_expected_max() > 0) entry.value = type.substr(0, type.find(':'));
    if (option.get_positional()) entry.value = option.get_name(true);
    entry.choices = choices_of(type);
    return entry;
}

void add(const CLI::App& command, const std::vector<std::string>& words, std::vector<CommandEntry>& tree) {
    CommandEntry entry{.words = words, .summary = command.get_description(), .footer = command.get_footer()};
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) continue;
        (option->nonpositional() ? entry.options : entry.positionals).push_back(entry_of(*option));
    }
    const auto below = command.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
    for (const CLI::App* one : below) entry.commands.push_back(one->get_name());
    tree.push_back(std::move(entry));
    for (const CLI::App* one : below) {
        std::vector<std::string> more = words;
        more.push_back(one->get_name());
        add(*one, more, tree);
    }
}

}  // namespace

std::vector<CommandEntry> command_tree(const CLI::App& app) {
    std::vector<CommandEntry> tree;
    add(app, {}, tree);
    return tree;
}

}  // namespace sheer::cli
