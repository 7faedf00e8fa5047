// Completion for shells.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "server/cli/rendering/command_tree.h"

namespace sheer::cli {

namespace {

std::string key_of(const CommandEntry& command) {
    return fmt::format("{}", fmt::join(command.words, " "));
}

std::vector<std::string> names_of(const CommandEntry& command) {
    std::vector<std::string> names = command.commands;
    for (const OptionEntry& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

/// A text between single quotes.
std::string in_quotes(std::string text) {
    for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
    return "'" + text + "'";
}

std::string bash_script(const std::vector<CommandEntry>& tree) {
    std::string arms, choices;
    for (const CommandEntry& command : tree) {
        arms += fmt::format("        {}) words={} ;;\n", in_quotes(key_of(command)),
                            in_quotes(fmt::format("{}", fmt::join(names_of(command), " "))));
        for (const OptionEntry& option : command.options)
            for (const std::string& name : option.names)
                if (!option.choices.empty())
                    choices += fmt::format("        {}) words={} ;;\n", in_quotes(key_of(command) + "|" + name),
                                           in_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
    }
    std::string known;
    for (const CommandEntry& command : tree)
        if (!command.words.empty()) known += fmt::format("{}{}", known.empty() ? "" : "|", in_quotes(key_of(command)));
    return fmt::format(R"(# Completion of sheer for bash: source <(sheer completion bash)
_sheer() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= words= i longer
    for ((i = 1; i < COMP_CWORD; ++i)); do
        longer="${{command:+$command }}${{COMP_WORDS[i]}}"
        case $longer in {0}) command=$longer ;; esac
    done
    case $command in
{1}    esac
    case "$command|$before" in
{2}    esac
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    if [[ ${{#COMPREPLY[@]}} == 0 && $word != -* ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}}
complete -F _sheer sheer
)",
                       known, arms, choices);
}

/// In zsh the functions of bash's completion work, once they are loaded.
std::string zsh_script(const std::vector<CommandEntry>& tree) {
    return "#compdef sheer\n# Completion of sheer for zsh: source <(sheer completion zsh)\n"
           "autoload -Uz compinit bashcompinit\n(( $+functions[compdef] )) || compinit\nbashcompinit\n" +
           bash_script(tree);
}

std::string fish_script(const std::vector<CommandEntry>& tree) {
    std::string script = "# Completion of sheer for fish: sheer completion fish | source\n";
    for (const CommandEntry& command : tree) {
        std::string when = "__fish_use_subcommand";
        if (!command.words.empty()) {
            when = "__fish_seen_subcommand_from " + command.words.front();
            if (command.words.size() > 1) when += "; and __fish_seen_subcommand_from " + command.words.back();
        }
        if (!command.commands.empty() && !command.words.empty())
            when += fmt::format("; and not __fish_seen_subcommand_from {}", fmt::join(command.commands, " "));
        for (const std::string& name : command.commands) {
            std::vector<std::string> words = command.words;
            words.push_back(name);
            for (const CommandEntry& below : tree)
                if (below.words == words)
                    script += fmt::format("complete -c sheer -f -n {} -a {} -d {}\n", in_quotes(when), name,
                                          in_quotes(below.summary));
        }
        for (const OptionEntry& option : command.options) {
            script += fmt::format("complete -c sheer -n {}", in_quotes(when));
            for (const std::string& name : option.names)
                script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (!option.choices.empty()) {
                script += fmt::format(" -x -a {}", in_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
            } else if (!option.value.empty()) {
                script += " -r";
            }
            script += fmt::format(" -d {}\n", in_quotes(option.summary));
        }
    }
    return script;
}

}  // namespace

std::string completion_script(const std::vector<CommandEntry>& tree, const std::string& shell) {
    if (shell == "zsh") return zsh_script(tree);
    return shell == "fish" ? fish_script(tree) : bash_script(tree);
}

void add_completion(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("completion", "Print a script that completes the command line");
    auto shell = std::make_shared<std::string>();
    command->add_option("shell", *shell, "The shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    command->footer("Example: sheer completion bash > ~/.local/share/bash-completion/completions/sheer");
    command->callback([shell, &app, &exit_code] {
        fmt::print("{}", completion_script(command_tree(app), *shell));
        exit_code = exit_ok;
    });
}

}  // namespace sheer::cli
