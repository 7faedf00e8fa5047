#pragma once
#include <sys/types.h>

#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/process/child_process.h"

namespace sheer {

/// A process of sheer-render that has its libraries loaded and forks the children of this process, which takes
/// milliseconds, where loading the libraries of picture formats takes a third of a second. It starts with the first
/// child, and anew if it has died. It reads nothing from others; each child confines itself.
class ForkServer {
  public:
    /// The path of sheer-render.
    explicit ForkServer(std::string program) : m_program(std::move(program)) {}
    ForkServer(const ForkServer&) = delete;
    ForkServer& operator=(const ForkServer&) = delete;
    ~ForkServer() = default;

    const std::string& program() const { return m_program; }

    /// The id of a new child of this process, with `output` as its standard output; -1 if it cannot be forked.
    pid_t fork(const ChildOptions& options, int output);

  private:
    void start();
    std::optional<pid_t> ask(const ChildOptions& options, int output);

    std::string m_program;
    std::mutex m_mutex;
    int m_socket = -1;  ///< the keeper's
    // Owns the process and lives as long: a child whose parent's starter is a thread that ended gets its orphan's
    // signal.
    std::jthread m_keeper;
};

/// What the process does: `socket` is its end of the connection. Returns, in the children only, what follows the
/// program's name in their command line, which also replaces the one of `argc` and `argv` in lists of processes. They
/// must end with _exit(): exit() would wait for threads of libraries that they do not have.
std::vector<std::string> serve_forks(int socket, int argc, char** argv);

/// The command of sheer-render that does so.
inline constexpr const char* fork_server_command = "fork-server";

}  // namespace sheer
