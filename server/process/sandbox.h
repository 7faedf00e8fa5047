#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheer {

// What a process takes from itself before it reads files or programs from others. There is no way back, for it and for
// its children. docs/security.md says what each part is for.

/// The files that a confined process may still open, besides those of the system: libraries, its own /proc entry,
/// devices of graphics cards.
struct OpenFiles {
    std::vector<std::filesystem::path> read;          ///< files, or folders with everything below
    std::vector<std::filesystem::path> read_by_name;  ///< folders whose files may be read but not listed
    std::vector<std::filesystem::path> write;         ///< folders
};

/// Something of the sandbox is missing on this system.
class SandboxError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Why there is no sandbox on this system: its kernel lacks Landlock or seccomp. "" if there is one.
std::string why_no_sandbox();

/// Closes all other files to this thread and the threads and processes that it starts: neither read nor written, made
/// nor executed. By Landlock; needs no privileges. Call it before a driver starts threads. Throws SandboxError.
void confine_files(const OpenFiles& open);

/// Leaves to all threads of this process the system calls that computing takes. Without: starting processes and
/// programs, sockets, signals to others, looking into other processes, changing names, owners and rights of files,
/// mounting, kernel interfaces such as io_uring, BPF and keys; these fail with EPERM. By seccomp. Throws SandboxError.
void confine_calls();

}  // namespace sheer
