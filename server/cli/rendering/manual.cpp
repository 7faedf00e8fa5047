// The manual, sheer(1).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "server/cli/rendering/command_tree.h"
#include "version.h"

namespace sheer::cli {

namespace {

/// Text for roff: dashes and backslashes stay what they are, and no line begins with a request.
std::string roff(const std::string& text) {
    std::string all;
    for (const char c : text) {
        const bool at_start = all.empty() || all.back() == '\n';
        if (at_start && (c == '.' || c == '\'')) all += "\\&";
        if (c == '\\') {
            all += "\\e";
        } else if (c == '-') {
            all += "\\-";
        } else {
            all += c;
        }
    }
    return all;
}

std::string option_paragraph(const OptionEntry& option) {
    std::string value = option.choices.empty() ? option.value : fmt::format("{}", fmt::join(option.choices, "|"));
    if (option.names.empty()) return fmt::format(".TP\n\\fI{}\\fR\n{}\n", roff(value), roff(option.summary));
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
    return fmt::format(".TP\n{}{}\n{}\n", names, value.empty() ? "" : " \\fI" + roff(value) + "\\fR",
                       roff(option.summary));
}

std::string command_section(const CommandEntry& command) {
    std::string text = fmt::format(".SS sheer {}\n{}.\n", roff(fmt::format("{}", fmt::join(command.words, " "))),
                                   roff(command.summary));
    for (const OptionEntry& word : command.positionals) text += option_paragraph(word);
    for (const OptionEntry& option : command.options)
        if (option.names.front() != "--help") text += option_paragraph(option);
    if (!command.footer.empty()) text += fmt::format(".PP\n{}\n", roff(command.footer));
    return text;
}

constexpr const char* exit_codes = R"(.SH EXIT STATUS
.TP
0
Done, and every check passed or stayed undecided.
.TP
1
A check failed, or what was compared differs.
.TP
2
The spec or the command line is wrong.
.TP
3
Rendering failed.
.TP
4
The server could not be reached in time.
.TP
5
A check stayed undecided, and the spec says that this counts.
.TP
128 + n
Ended by signal n.
.SH ENVIRONMENT
.TP
SHEER_SERVER
The service that \fBsheer submit\fR and \fBsheer baseline\fR use without \fB\-\-server\fR.
.TP
NO_COLOR
If it is set and not empty, nothing is coloured. Without it, only a terminal gets colours.
.TP
SPDLOG_LEVEL
The least severe messages of the log, such as info.
)";

}  // namespace

std::string manual_page(const std::vector<CommandEntry>& tree) {
    std::string text = fmt::format(
        ".TH SHEER 1 \"\" \"sheer {}\" \"User Commands\"\n.SH NAME\nsheer \\- compare transparency methods\n"
        ".SH SYNOPSIS\n\\fBsheer\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n.SH DESCRIPTION\n{}\n.SH COMMANDS\n",
        version, roff(tree.front().summary));
    for (const CommandEntry& command : tree)
        if (!command.words.empty()) text += command_section(command);
    return text + exit_codes;
}

void add_manual(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("manual", "Print the manual for man(1)")->group("");
    command->callback([&app, &exit_code] {
        fmt::print("{}", manual_page(command_tree(app)));
        exit_code = exit_ok;
    });
}

}  // namespace sheer::cli
