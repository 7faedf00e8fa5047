#include <gtest/gtest.h>

#include "renderer/command/wrong_words.h"
#include "renderer/core/similar_name.h"
#include "server/cli/rendering/command_tree.h"

namespace sheer::cli::command_line_test {
namespace {

TEST(EditDistance, CountsLettersThatDiffer) {
    EXPECT_EQ(edit_distance("", ""), 0U);
    EXPECT_EQ(edit_distance("abc", ""), 3U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(edit_distance("comapre", "compare"), 1U);
    EXPECT_EQ(edit_distance("ca", "abc"), 3U);
}

TEST(SimilarName, NeedsMostLettersToAgree) {
    const std::vector<std::string> names{"compare", "submit", "diff", "f2bd", "f2bx"};
    EXPECT_EQ(similar_name("comapre", names), "compare");
    EXPECT_EQ(similar_name("COMPARE", names), "compare");
    EXPECT_EQ(similar_name("sub", names), "submit");
    EXPECT_EQ(similar_name("dif", names), "diff");
    EXPECT_EQ(similar_name("f2db", {"f2b", "f2bd"}), "f2bd");
    EXPECT_EQ(similar_name("frobnicate", names), "");
    EXPECT_EQ(similar_name("x", names), "");
}

TEST(TimeLeft, IsToldOnceItCanBeKnown) {
    EXPECT_EQ(time_left(2, 0.5), "");
    EXPECT_EQ(time_left(100, 0.01), "");
    EXPECT_EQ(time_left(100, 1), "");
    EXPECT_EQ(time_left(10, 0.5), "10 s left, ");
    EXPECT_EQ(time_left(60, 0.25), "3 min left, ");
    EXPECT_EQ(time_left(1000, 0.1), "2.5 h left, ");
}

class Program : public testing::Test {
  protected:
    Program() {
        m_app.require_subcommand(1);
        CLI::App* draw = m_app.add_subcommand("draw", "Draw it");
        draw->add_option("file", m_file, "It's the file");
        draw->add_option("--mode", m_mode, "How")->check(CLI::IsMember({"fast", "slow"}));
        draw->add_flag("-q,--quiet", m_quiet, "No output");
        draw->footer("Example: sheer draw a.json");
        CLI::App* set = m_app.add_subcommand("set", "A set");
        set->require_subcommand(1);
        set->add_subcommand("list", "List it");
        m_app.add_subcommand("secret", "Hidden")->group("");
    }

    std::string wrong(std::vector<std::string> words) {
        std::reverse(words.begin(), words.end());
        try {
            m_app.parse(words);
        } catch (const CLI::ParseError& error) {
            const std::string what = what_is_wrong(m_app, error);
            return what.substr(0, what.find('\n'));
        }
        return "";
    }

    CLI::App m_app{"Draws.", "sheer"};
    std::string m_file, m_mode;
    bool m_quiet = false;
};

TEST_F(Program, WrongWordsAreNamedWithWhatWasMeant) {
    EXPECT_EQ(wrong({"frobnicate"}), "sheer: there is no command \"frobnicate\"");
    EXPECT_EQ(wrong({"darw"}), "sheer: there is no command \"darw\"; did you mean draw?");
    EXPECT_EQ(wrong({"set", "lits"}), "sheer set: there is no command \"lits\"; did you mean list?");
    EXPECT_EQ(wrong({"draw", "--mdoe=fast"}), "sheer draw: there is no option --mdoe; did you mean --mode?");
    EXPECT_EQ(wrong({"draw", "a", "b"}), "sheer draw: \"b\" is one word too many");
    EXPECT_EQ(wrong({}), "sheer: a command is missing");
    EXPECT_EQ(wrong({"set"}), "sheer set: a command is missing");
    EXPECT_NE(wrong({"draw", "--mode", "dull"}).find("--mode: dull not in {fast,slow}"), std::string::npos);
    EXPECT_EQ(wrong({"draw", "a", "-q"}), "");
}

TEST_F(Program, TheTreeHasWhatTheHelpShows) {
    const auto tree = command_tree(m_app);
    ASSERT_EQ(tree.size(), 4U);
    EXPECT_EQ(tree[0].commands, (std::vector<std::string>{"draw", "set"}));
    const CommandEntry& draw = tree[1];
    EXPECT_EQ(draw.positionals.at(0).value, "file");
    const OptionEntry& mode = draw.options.at(1);
    EXPECT_EQ(mode.names, std::vector<std::string>{"--mode"});
    EXPECT_EQ(mode.value, "TEXT");
    EXPECT_EQ(mode.choices, (std::vector<std::string>{"fast", "slow"}));
    EXPECT_EQ(draw.options.at(2).value, "");
    EXPECT_EQ(tree[3].words, (std::vector<std::string>{"set", "list"}));
}

TEST_F(Program, TheManualHasEveryOption) {
    const std::string manual = manual_page(command_tree(m_app));
    EXPECT_NE(manual.find(".SS sheer set list\n"), std::string::npos);
    EXPECT_NE(manual.find(".TP\n\\fB\\-\\-mode\\fR \\fIfast|slow\\fR\nHow\n"), std::string::npos);
    EXPECT_NE(manual.find(".TP\n\\fB\\-\\-quiet\\fR, \\fB\\-q\\fR\nNo output\n"), std::string::npos);
    EXPECT_NE(manual.find("Example: sheer draw a.json"), std::string::npos);
    EXPECT_EQ(manual.find("secret"), std::string::npos);
}

}  // namespace
}  // namespace sheer::cli::command_line_test
