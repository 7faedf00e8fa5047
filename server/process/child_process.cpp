#include "server/process/child_process.h"

#include <fcntl.h>
#include <linux/sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "renderer/core/exit_codes.h"
#include "server/process/fork_server.h"

namespace sheer {

const unsigned long child_namespaces =
    CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWIPC | CLONE_NEWUTS | CLONE_NEWNS;

namespace {

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

std::vector<char*> argument_pointers(std::string& name, std::vector<std::string>& arguments) {
    std::vector<char*> pointers{name.data()};
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// Like fork().
pid_t fork_into_namespaces() {
    return static_cast<pid_t>(syscall(SYS_clone, child_namespaces | SIGCHLD, nullptr, nullptr, nullptr, nullptr));
}

ExitStatus status_of(int wait_status) {
    if (WIFSIGNALED(wait_status)) return {-1, WTERMSIG(wait_status)};
    return {WEXITSTATUS(wait_status), 0};
}

/// Ours and `added`, for execve; none of them is in both.
std::vector<char*> environment_pointers(std::vector<std::string>& added) {
    std::vector<char*> pointers;
    for (std::string& variable : added) pointers.push_back(variable.data());
    for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable)
        pointers.push_back(*variable);
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

bool limits_memory() {
#ifdef __SANITIZE_ADDRESS__
    return false;
#else
    return true;
#endif
}

void settle_child(const ChildOptions& options, int output, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, options.signal_when_orphaned);
    // The parent may have died before prctl was called. A process in another namespace has no number here.
    if (const pid_t now = getppid(); now != parent && now != 0) _exit(exit_not_started);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    std::signal(SIGPIPE, SIG_DFL);
    // On SIGHUP the service reloads its configuration; its children, and theirs, which inherit this, continue.
    std::signal(SIGHUP, SIG_IGN);
    if (limits_memory() && options.memory_limit_bytes > 0) {
        const rlimit limit{options.memory_limit_bytes, options.memory_limit_bytes};
        setrlimit(RLIMIT_AS, &limit);
    }
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const int input = options.input >= 0 ? options.input : open("/dev/null", O_RDONLY | O_CLOEXEC);
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    // Otherwise a child would keep the service's listening socket and connections open.
    close_range(STDERR_FILENO + 1, ~0u, 0);
}

ChildProcess::ChildProcess(const ChildOptions& options) {
    std::array<int, 2> pipe_ends{-1, -1};
    if (options.capture_output && pipe2(pipe_ends.data(), O_CLOEXEC) != 0) fail("pipe");
    std::string name = "sheer";
    std::vector<std::string> arguments = options.arguments;
    const std::vector<char*> pointers = argument_pointers(name, arguments);
    std::vector<std::string> added = options.environment;
    const std::vector<char*> variables = environment_pointers(added);
    const pid_t parent = getpid();
    const int output = options.capture_output ? pipe_ends[1] : STDERR_FILENO;
    if (options.fork_server && options.fork_server->program() == options.program)
        m_pid = options.fork_server->fork(options, output);
    if (m_pid < 0 && options.own_namespaces) m_pid = fork_into_namespaces();
    if (m_pid < 0) m_pid = fork();
    if (m_pid == 0) {
        settle_child(options, output, parent);
        execve(options.program.c_str(), pointers.data(), variables.data());
        _exit(exit_not_started);
    }
    const int fork_error = errno;
    if (options.capture_output) {
        close(pipe_ends[1]);
        m_output = pipe_ends[0];
    }
    if (m_pid < 0) {
        if (m_output >= 0) close(m_output);
        errno = fork_error;
        fail("fork");
    }
    // Both sides do this, so that the group exists whichever runs first.
    setpgid(m_pid, m_pid);
    if (m_output >= 0) fcntl(m_output, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    if (!m_status) {
        signal(SIGKILL);
        wait();
    }
    if (m_output >= 0) close(m_output);
}

std::optional<ExitStatus> ChildProcess::poll() {
    int wait_status = 0;
    if (!m_status && waitpid(m_pid, &wait_status, WNOHANG) == m_pid) m_status = status_of(wait_status);
    return m_status;
}

ExitStatus ChildProcess::wait() {
    int wait_status = 0;
    while (!m_status) {
        const pid_t ended = waitpid(m_pid, &wait_status, 0);
        if (ended == m_pid) m_status = status_of(wait_status);
        if (ended < 0 && errno != EINTR) m_status = ExitStatus{};
    }
    return *m_status;
}

void ChildProcess::signal(int number) {
    // Once it is reaped the number may belong to another process.
    if (!m_status) kill(-m_pid, number);
}

std::vector<std::string> LineReader::feed(std::string_view bytes) {
    std::vector<std::string> lines;
    while (!bytes.empty()) {
        const std::size_t end = bytes.find('\n');
        const std::string_view part = bytes.substr(0, end);
        m_dropping = m_dropping || m_partial.size() + part.size() > m_max_bytes;
        if (m_dropping) {
            m_partial.clear();
        } else {
            m_partial += part;
        }
        if (end == std::string_view::npos) break;
        if (!m_dropping) lines.push_back(std::move(m_partial));
        m_partial.clear();
        m_dropping = false;
        bytes.remove_prefix(end + 1);
    }
    return lines;
}

bool read_available(int descriptor, std::string& bytes) {
    std::array<char, 16384> buffer;
    // Bounded, so that a child that never stops writing cannot block us here.
    for (int turns = 0; turns < 64; ++turns) {
        const ssize_t count = read(descriptor, buffer.data(), buffer.size());
        if (count > 0) {
            bytes.append(buffer.data(), static_cast<std::size_t>(count));
        } else if (count == 0) {
            return false;
        } else if (errno != EINTR) {
            return errno == EAGAIN;
        }
    }
    return true;
}

}  // namespace sheer
