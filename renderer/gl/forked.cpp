#include "renderer/gl/forked.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>

namespace sheer::gl {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void throw_errno(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

void write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(descriptor, text.data(), text.size());
        if (written < 0 && errno != EINTR) _exit(1);
        if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    }
}

[[noreturn]] void be_child(const std::function<void(const Say&)>& work, int output) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGINT, SIGTERM, SIGHUP})
        std::signal(signal, SIG_DFL);
    // The same is printed again by the process that then does the real work.
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    try {
        work([output](const std::string& line) { write_all(output, line + "\n"); });
    } catch (...) {
        _exit(1);
    }
    _exit(0);
}

/// Appends what is read until the end of the file; false if that does not come in time.
bool read_until(int descriptor, Clock::time_point deadline, std::string& text) {
    std::array<char, 4096> buffer;
    while (true) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        pollfd readable{descriptor, POLLIN, 0};
        const int ready = left <= 0 ? 0 : poll(&readable, 1, static_cast<int>(left));
        if (ready == 0) return false;
        const ssize_t count = ready < 0 ? -1 : read(descriptor, buffer.data(), buffer.size());
        if (count == 0) return true;
        if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

std::vector<std::string> whole_lines(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
        lines.push_back(text.substr(begin, end - begin));
    return lines;
}

std::string trouble_of(int status) {
    if (WIFSIGNALED(status)) return fmt::format("crashed (signal {})", WTERMSIG(status));
    return WEXITSTATUS(status) == 0 ? "" : fmt::format("ended the process (exit code {})", WEXITSTATUS(status));
}

}  // namespace

ForkedRun run_forked(const std::function<void(const Say& say)>& work, std::chrono::milliseconds time_limit) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_errno("pipe");
    const pid_t child = fork();
    if (child == 0) be_child(work, ends[1]);
    const int fork_error = errno;
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        errno = fork_error;
        throw_errno("fork");
    }
    std::string text;
    const bool late = !read_until(ends[0], Clock::now() + time_limit, text);
    if (late) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    close(ends[0]);
    return {whole_lines(text),
            late ? fmt::format("gave no answer within {} ms", time_limit.count()) : trouble_of(status)};
}

}  // namespace sheer::gl
