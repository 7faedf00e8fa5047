#include "server/process/fork_server.h"

#include <linux/sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "renderer/core/exit_codes.h"

namespace sheer {

namespace {

using nlohmann::json;

// The most that a command line of a child takes.
constexpr std::size_t command_line_bytes = 4096;
constexpr std::size_t message_bytes = 65536;

/// Calls again what a signal has interrupted: a request whose answer is missed would leave a child that nobody knows.
ssize_t uninterrupted(const auto& call) {
    ssize_t result = -1;
    do result = call();
    while (result < 0 && errno == EINTR);
    return result;
}

/// A message with up to two files: one end sends, the other receives.
class Message {
  public:
    Message(void* bytes, std::size_t size) : m_bytes{bytes, size} {
        m_header.msg_iov = &m_bytes;
        m_header.msg_iovlen = 1;
    }

    bool send(int socket, int output, int input) {
        const std::array<int, 2> files{output, input};
        const std::size_t files_bytes = (input >= 0 ? 2 : 1) * sizeof(int);
        m_header.msg_control = m_control.data();
        m_header.msg_controllen = CMSG_SPACE(files_bytes);
        cmsghdr* part = CMSG_FIRSTHDR(&m_header);
        part->cmsg_level = SOL_SOCKET;
        part->cmsg_type = SCM_RIGHTS;
        part->cmsg_len = CMSG_LEN(files_bytes);
        std::memcpy(CMSG_DATA(part), files.data(), files_bytes);
        const ssize_t sent = uninterrupted([&] { return sendmsg(socket, &m_header, MSG_NOSIGNAL); });
        return sent == static_cast<ssize_t>(m_bytes.iov_len);
    }

    /// How many bytes came, and which files, -1 for none.
    ssize_t receive(int socket, int& output, int& input) {
        m_header.msg_control = m_control.data();
        m_header.msg_controllen = m_control.size();
        const ssize_t count = uninterrupted([&] { return recvmsg(socket, &m_header, MSG_CMSG_CLOEXEC); });
        std::array<int, 2> files{-1, -1};
        if (const cmsghdr* part = CMSG_FIRSTHDR(&m_header); count > 0 && part)
            std::memcpy(files.data(), CMSG_DATA(part), std::min(sizeof(files), part->cmsg_len - CMSG_LEN(0)));
        output = files[0];
        input = files[1];
        return count;
    }

  private:
    iovec m_bytes;
    msghdr m_header{};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> m_control{};
};

std::string message_of(const ChildOptions& options) {
    return json{{"arguments", options.arguments},
                {"memory_limit_bytes", options.memory_limit_bytes},
                {"own_namespaces", options.own_namespaces},
                {"signal_when_orphaned", options.signal_when_orphaned}}
        .dump();
}

ChildOptions options_of(const json& message) {
    return {.arguments = message.at("arguments"),
            .memory_limit_bytes = message.at("memory_limit_bytes"),
            .own_namespaces = message.at("own_namespaces"),
            .signal_when_orphaned = message.at("signal_when_orphaned")};
}

/// Like fork(), but the child is one of this process's parent, which waits for it.
pid_t fork_sibling(bool own_namespaces) {
    // Where the C library keeps the number of this thread, which differs in the child.
    int* thread_id = nullptr;
    if (prctl(PR_GET_TID_ADDRESS, &thread_id) != 0) return -1;
    clone_args arguments{};
    arguments.flags = CLONE_PARENT | CLONE_CHILD_SETTID | CLONE_CHILD_CLEARTID;
    arguments.child_tid = reinterpret_cast<std::uintptr_t>(thread_id);
    if (own_namespaces) arguments.flags |= child_namespaces;
    return static_cast<pid_t>(syscall(SYS_clone3, &arguments, sizeof(arguments)));
}

/// Some libraries start threads when they are loaded, which a child does not get. Until these rest they may hold a
/// lock, which in a child nobody would release. False if they do not within seconds.
bool wait_until_other_threads_rest() {
    const auto rests = [](const std::filesystem::directory_entry& thread) {
        std::ifstream file(thread.path() / "stat");
        const std::string stat((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
        const std::size_t name_end = stat.rfind(')');
        return name_end != std::string::npos && stat.substr(name_end).starts_with(") S");
    };
    const std::string own = std::to_string(gettid());
    const auto rests_or_is_this_one = [&](const std::filesystem::directory_entry& thread) {
        return thread.path().filename() == own || rests(thread);
    };
    for (int tries = 0; tries < 10000; ++tries) {
        if (std::ranges::all_of(std::filesystem::directory_iterator("/proc/self/task"), rests_or_is_this_one))
            return true;
        usleep(1000);
    }
    return false;
}

/// Writes the words over the command line of this process, as far as they fit.
void replace_command_line(const std::vector<std::string>& words, int argc, char** argv) {
    char* const begin = argv[0];
    char* const end = argv[argc - 1] + std::strlen(argv[argc - 1]);
    std::string line = "sheer";
    for (const std::string& word : words) line.append(1, '\0').append(word);
    line.resize(static_cast<std::size_t>(end - begin));
    std::ranges::copy(line, begin);
}

/// The process, and our end of the connection to it.
class Server {
  public:
    explicit Server(const std::string& program) {
        std::array<int, 2> ends{-1, -1};
        if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
        m_socket = ends[0];
        try {
            m_process.emplace(ChildOptions{.program = program,
                                           .arguments = {fork_server_command, std::string(command_line_bytes, ' ')},
                                           .input = ends[1],
                                           .capture_output = false});
        } catch (const std::system_error&) {
            close(m_socket);
            m_socket = -1;
        }
        close(ends[1]);
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() {
        if (m_socket >= 0) close(m_socket);
    }

    /// -1 if there is none.
    int socket() const { return m_socket; }

  private:
    int m_socket = -1;
    std::optional<ChildProcess> m_process;
};

}  // namespace

pid_t ForkServer::fork(const ChildOptions& options, int output) {
    const std::lock_guard lock(m_mutex);
    std::optional<pid_t> child = ask(options, output);
    if (!child) {
        start();
        child = ask(options, output);
    }
    return child.value_or(-1);
}

void ForkServer::start() {
    std::promise<int> socket;
    std::future<int> started = socket.get_future();
    m_keeper = std::jthread([this, socket = std::move(socket)](const std::stop_token& stop) mutable {
        const Server server(m_program);
        socket.set_value(server.socket());
        std::mutex mutex;
        std::unique_lock lock(mutex);
        std::condition_variable_any().wait(lock, stop, [] { return false; });
    });
    m_socket = started.get();
}

/// Nothing if there is no such process.
std::optional<pid_t> ForkServer::ask(const ChildOptions& options, int output) {
    std::string bytes = message_of(options);
    pid_t child = -1;
    if (m_socket < 0) return std::nullopt;
    if (!Message(bytes.data(), bytes.size()).send(m_socket, output, options.input)) return std::nullopt;
    const ssize_t received = uninterrupted([&] { return recv(m_socket, &child, sizeof(child), 0); });
    if (received != sizeof(child)) return std::nullopt;
    return child;
}

std::vector<std::string> serve_forks(int socket, int argc, char** argv) {
    const pid_t parent = getppid();
    // Without it children are started as programs.
    if (!wait_until_other_threads_rest()) _exit(exit_not_started);
    std::string bytes(message_bytes, '\0');
    while (true) {
        int output = -1, input = -1;
        const ssize_t count = Message(bytes.data(), bytes.size()).receive(socket, output, input);
        if (count <= 0) _exit(0);
        ChildOptions options = options_of(json::parse(bytes.begin(), bytes.begin() + count));
        options.input = input;
        pid_t child = options.own_namespaces ? fork_sibling(true) : -1;
        if (child < 0) child = fork_sibling(false);
        if (child == 0) {
            settle_child(options, output, parent);
            replace_command_line(options.arguments, argc, argv);
            return options.arguments;
        }
        close(output);
        if (input >= 0) close(input);
        if (send(socket, &child, sizeof(child), MSG_NOSIGNAL) < 0) _exit(0);
    }
}

}  // namespace sheer
