#include "renderer/command/wrong_words.h"

#include <fmt/format.h>

#include "renderer/core/similar_name.h"

namespace sheer::cli {

namespace {

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
    const std::string meant = similar_name(word, names);
    return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
}

std::string wrong_word(const CLI::App& command, std::string word) {
    if (word.starts_with('-')) {
        word = word.substr(0, word.find('='));
        return fmt::format("there is no option {}{}", word, suggestion(word, option_names(command)));
    }
    const auto commands = shown_commands(command);
    if (commands.empty()) return fmt::format("\"{}\" is one word too many", word);
    return fmt::format("there is no command \"{}\"{}", word, suggestion(word, commands));
}

}  // namespace

ChosenCommand chosen_command(const CLI::App& app) {
    ChosenCommand chosen{&app, app.get_name()};
    while (!chosen.app->get_subcommands().empty()) {
        chosen.app = chosen.app->get_subcommands().front();
        chosen.name += " " + chosen.app->get_name();
    }
    return chosen;
}

std::vector<std::string> shown_commands(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error) {
    const ChosenCommand chosen = chosen_command(app);
    const auto unread = app.remaining(true);
    std::string what = unread.empty() ? std::string(error.what()) : wrong_word(*chosen.app, unread.front());
    if (unread.empty() && !shown_commands(*chosen.app).empty()) what = "a command is missing";
    return fmt::format("{}: {}\n{} --help lists what there is", chosen.name, what, chosen.name);
}

}  // namespace sheer::cli
