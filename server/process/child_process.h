#pragma once
#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

class ForkServer;

/// This program itself, even if its file was replaced or removed since it started.
inline constexpr const char* own_program = "/proc/self/exe";

struct ChildOptions {
    std::string program = own_program;
    std::vector<std::string> arguments;  ///< without the program's name
    /// NAME=VALUE, besides our own environment; not for a child that a fork server makes.
    std::vector<std::string> environment = {};
    std::uint64_t memory_limit_bytes = 0;  ///< address space (RLIMIT_AS); 0: no limit
    int input = -1;                        ///< its standard input; -1: empty
    bool capture_output = true;            ///< otherwise the child writes to our standard error
    /// In namespaces of its own where the system permits it: no network, no sight of other processes, no privileges.
    bool own_namespaces = false;
    int signal_when_orphaned = SIGKILL;  ///< what the child gets when the thread that started it ends
    /// Forks the child if it is one of `program`, which otherwise is started; may be null.
    std::shared_ptr<ForkServer> fork_server = nullptr;
};

/// Whether memory_limit_bytes has an effect: not with AddressSanitizer, which reserves terabytes of address space.
bool limits_memory();

/// How a process ended.
struct ExitStatus {
    int code = -1;   ///< -1 if it died by a signal
    int signal = 0;  ///< 0 if it exited
};

/// A process in its own process group, which is killed and reaped when this object is destroyed. It inherits no files
/// except standard input, output and error.
class ChildProcess {
  public:
    /// Throws std::system_error.
    explicit ChildProcess(const ChildOptions& options);
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    pid_t pid() const { return m_pid; }
    /// Readable end of the child's standard output, non-blocking; -1 if it is not captured.
    int output() const { return m_output; }
    /// Nothing while it runs.
    std::optional<ExitStatus> poll();
    ExitStatus wait();
    /// Sends a signal to the whole group.
    void signal(int number);

  private:
    pid_t m_pid = -1;
    int m_output = -1;
    std::optional<ExitStatus> m_status;
};

/// Makes a new process, in which only async-signal-safe calls are allowed, a child as the options say: its group,
/// signals, limits and files.
void settle_child(const ChildOptions& options, int output, pid_t parent);

/// What `own_namespaces` stands for, as flags of clone().
extern const unsigned long child_namespaces;

/// Splits the output of a child into lines. A line over `max_bytes` is dropped, so that a faulty child does not fill
/// the memory.
class LineReader {
  public:
    explicit LineReader(std::size_t max_bytes) : m_max_bytes(max_bytes) {}
    /// The lines that `bytes` completes, without their ends.
    std::vector<std::string> feed(std::string_view bytes);

  private:
    std::size_t m_max_bytes;
    std::string m_partial;
    bool m_dropping = false;
};

/// Appends what is readable now, at most 1 MiB. Returns false at the end of the file.
bool read_available(int descriptor, std::string& bytes);

}  // namespace sheer
