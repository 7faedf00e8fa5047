#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "server/children/device_list.h"
#include "server/process/child_message.h"
#include "server/process/run_child.h"
#include "server/process/stop_signal.h"
#include "temporary_folder.h"

namespace sheer::test::child_process_test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

struct Ran {
    ChildResult result;
    std::vector<std::string> lines;
};

Ran run_shell(const std::string& script, std::chrono::milliseconds time_limit = 20s,
              std::function<bool()> keep_going = nullptr, std::uint64_t memory_limit_bytes = 0) {
    Ran ran;
    ChildRun run;
    run.options = {.program = "/bin/sh", .arguments = {"-c", script}, .memory_limit_bytes = memory_limit_bytes};
    run.time_limit = time_limit;
    run.on_line = [&ran](const std::string& line) { ran.lines.push_back(line); };
    run.keep_going = std::move(keep_going);
    ran.result = run_child(run);
    return ran;
}

/// Whether the process has ended, reaped or not.
bool is_dead(pid_t pid) {
    std::ifstream stat(fmt::format("/proc/{}/stat", pid));
    std::string number, name, state;
    return !(stat >> number >> name >> state) || state == "Z" || state == "X";
}

bool dies_soon(pid_t pid) {
    for (int i = 0; i < 500 && !is_dead(pid); ++i) std::this_thread::sleep_for(10ms);
    return is_dead(pid);
}

TEST(RunChild, ReturnsItsLinesAndItsExitCode) {
    const Ran ran = run_shell("echo one; echo two; exit 3");
    EXPECT_EQ(ran.result.status.code, 3);
    EXPECT_EQ(ran.result.status.signal, 0);
    EXPECT_THAT(ran.lines, ElementsAre("one", "two"));
}

TEST(RunChild, ReportsASignal) {
    EXPECT_EQ(run_shell("kill -SEGV $$").result.status.signal, SIGSEGV);
    EXPECT_EQ(run_shell("kill -KILL $$").result.status.code, -1);
}

TEST(RunChild, AMissingProgramEndsWith127) {
    ChildRun run;
    run.options.program = "/nonexistent/program";
    run.time_limit = 10s;
    EXPECT_EQ(run_child(run).status.code, 127);
}

TEST(RunChild, KillsTheWholeGroupAtTheLimit) {
    const Ran ran = run_shell("sleep 60 & echo $!; wait", 300ms);
    EXPECT_TRUE(ran.result.timed_out);
    EXPECT_FALSE(ran.result.stopped);
    ASSERT_EQ(ran.lines.size(), 1u);
    EXPECT_TRUE(dies_soon(std::stoi(ran.lines[0])));
}

TEST(RunChild, StopsWhenAsked) {
    int asked = 0;
    const Ran ran = run_shell("sleep 60", 20s, [&] { return ++asked < 3; });
    EXPECT_TRUE(ran.result.stopped);
    EXPECT_FALSE(ran.result.timed_out);
    EXPECT_EQ(asked, 3);
}

TEST(RunChild, WaitsForAChildThatClosedItsOutput) {
    EXPECT_EQ(run_shell("exec >&-; sleep 0.2; exit 5").result.status.code, 5);
}

TEST(RunChild, IsKilledWhenAFunctionThrows) {
    pid_t pid = 0;
    ChildRun run;
    run.options = {.program = "/bin/sh", .arguments = {"-c", "echo $$; sleep 60"}};
    run.time_limit = 20s;
    run.on_line = [&](const std::string& line) {
        pid = std::stoi(line);
        throw std::runtime_error("no");
    };
    EXPECT_THROW(run_child(run), std::runtime_error);
    EXPECT_TRUE(is_dead(pid));
}

TEST(RunChild, InheritsNoFiles) {
    const TemporaryFolder folder;
    const int open_file = open(folder.file("file", "").c_str(), O_RDONLY);  // without O_CLOEXEC
    const Ran ran = run_shell(fmt::format("[ -e /proc/$$/fd/{} ] && echo open || echo closed", open_file));
    close(open_file);
    EXPECT_THAT(ran.lines, ElementsAre("closed"));
}

TEST(RunChild, LimitsItsMemory) {
    if (!limits_memory()) GTEST_SKIP() << "not with AddressSanitizer";
    EXPECT_THAT(run_shell("ulimit -v", 20s, nullptr, 64 << 20).lines, ElementsAre("65536"));
}

TEST(RunChild, DiesWithTheThreadThatStartedIt) {
    pid_t pid = 0;
    std::unique_ptr<ChildProcess> child;
    std::thread([&] {
        child = std::make_unique<ChildProcess>(
            ChildOptions{.program = "/bin/sh", .arguments = {"-c", "echo up; exec sleep 60"}});
        pid = child->pid();
        wait_readable({child->output()}, 20'000);
    }).join();
    EXPECT_TRUE(dies_soon(pid));
    EXPECT_EQ(child->wait().signal, SIGKILL);
}

TEST(LineReaderTest, JoinsPiecesOfALine) {
    LineReader reader(10);
    EXPECT_THAT(reader.feed("ab"), IsEmpty());
    EXPECT_THAT(reader.feed("c\nde\n\nf"), ElementsAre("abc", "de", ""));
    EXPECT_THAT(reader.feed("\n"), ElementsAre("f"));
}

TEST(LineReaderTest, DropsLinesThatAreTooLong) {
    LineReader reader(3);
    EXPECT_THAT(reader.feed("abcd\nabc\n"), ElementsAre("abc"));
    EXPECT_THAT(reader.feed("ab"), IsEmpty());
    EXPECT_THAT(reader.feed("cd"), IsEmpty());
    EXPECT_THAT(reader.feed("e\nok\n"), ElementsAre("ok"));
}

TEST(ChildMessageTest, Progress) {
    const auto progress = std::get<ChildProgress>(read_child_message(R"({"progress": 0.25, "stage": "timing"})"));
    EXPECT_EQ(progress.fraction, 0.25);
    EXPECT_EQ(progress.stage, "timing");
    EXPECT_EQ(std::get<ChildProgress>(read_child_message(R"({"progress": 7})")).fraction, 1);
    EXPECT_EQ(std::get<ChildProgress>(read_child_message(R"({"progress": -1, "stage": 5})")).stage, "");
}

TEST(ChildMessageTest, Errors) {
    const auto unsupported =
        std::get<ChildError>(read_child_message(R"({"error": {"kind": "unsupported", "detail": "no textures"}})"))
            .error;
    EXPECT_EQ(unsupported.title, "Not supported on this device");
    EXPECT_EQ(unsupported.detail, "no textures");
    EXPECT_EQ(std::get<ChildError>(read_child_message(R"({"error": {"kind": "odd"}})")).error.title,
              "Rendering failed");
}

TEST(ChildMessageTest, AnythingElseIsIgnored) {
    for (const char* line : {"", "libEGL warning", "[]", "5", "{", "{}", R"({"progress": "x"})", R"({"error": "x"})"})
        EXPECT_TRUE(std::holds_alternative<std::monostate>(read_child_message(line))) << line;
}

TEST(ChildMessageTest, LongTextsAreCutBetweenCharacters) {
    std::string stage;
    for (int i = 0; i < 200; ++i) stage += "ä";
    const std::string cut =
        std::get<ChildProgress>(read_child_message(nlohmann::json{{"progress", 0}, {"stage", "x" + stage}}.dump()))
            .stage;
    EXPECT_EQ(cut.size(), 199u + 3);
    EXPECT_NO_THROW(nlohmann::json(cut).dump());
}

TEST(DeviceListTest, IsCached) {
    const TemporaryFolder folder;
    const auto script =
        folder.file("devices", "#!/bin/sh\necho x >> " + (folder.path() / "asked").string() +
                                   "\n[ \"$1 $2\" = 'devices --json' ] && echo '[{\"name\":' && echo '\"a\"}]'\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    DeviceList devices(1h, script);
    EXPECT_EQ(devices.get()[0]["name"], "a");
    devices.get();
    EXPECT_EQ(std::filesystem::file_size(folder.path() / "asked"), 2u);
}

TEST(DeviceListTest, AChildThatFailsIsAnError) {
    EXPECT_THROW(DeviceList(1h, "/bin/false").get(), std::runtime_error);
    EXPECT_THROW(DeviceList(1h, "/bin/echo").get(), std::exception);
}

}  // namespace
}  // namespace sheer::test::child_process_test
