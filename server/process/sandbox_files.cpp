// Landlock, by its system calls: the C library of Debian 12 has no functions for them, and its kernel headers do not
// know the parts that are newer than Linux 6.1. See https://docs.kernel.org/userspace-api/landlock.html.
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "server/process/sandbox.h"

namespace sheer {

namespace fs = std::filesystem;

namespace {

/// struct landlock_ruleset_attr as of version 6.
struct RulesetAttributes {
    std::uint64_t files = 0, ports = 0, scoped = 0;
};

constexpr std::uint64_t read_file_right = LANDLOCK_ACCESS_FS_READ_FILE;
constexpr std::uint64_t read_rights = read_file_right | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t truncate_right = std::uint64_t{1} << 14;
constexpr std::uint64_t device_right = std::uint64_t{1} << 15;
constexpr std::uint64_t write_rights = read_rights | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG |
                                       LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE | truncate_right;
/// Those that a rule for a single file may have.
constexpr std::uint64_t file_rights =
    read_file_right | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE | truncate_right | device_right;
constexpr std::uint64_t device_rights = read_rights | LANDLOCK_ACCESS_FS_WRITE_FILE | device_right;

/// Every right that a version of Landlock knows, so that all are taken away.
std::uint64_t rights_of_version(long version) {
    constexpr int first_version_bits = 13;
    int bits = first_version_bits;
    if (version >= 2) bits = 14;
    if (version >= 3) bits = 15;
    if (version >= 5) bits = 16;
    return (std::uint64_t{1} << bits) - 1;
}

long landlock_version() {
    return syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
}

[[noreturn]] void fail_landlock(const char* what) {
    throw SandboxError(fmt::format("Landlock: {}: {}", what, std::strerror(errno)));
}

class Ruleset {
  public:
    explicit Ruleset(long version) : m_rights(rights_of_version(version)) {
        // TCP ports from version 4 on; abstract sockets and signals, which may not leave the process and its children,
        // from version 6 on.
        RulesetAttributes attributes{
            .files = m_rights, .ports = version >= 4 ? 3u : 0u, .scoped = version >= 6 ? 3u : 0u};
        std::size_t size = sizeof attributes.files;
        if (version >= 4) size += sizeof attributes.ports;
        if (version >= 6) size += sizeof attributes.scoped;
        m_descriptor = static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, size, 0));
        if (m_descriptor < 0) fail_landlock("no set of rules");
    }
    Ruleset(const Ruleset&) = delete;
    Ruleset& operator=(const Ruleset&) = delete;
    ~Ruleset() { close(m_descriptor); }

    /// Nothing if there is no such file or folder.
    void allow(const fs::path& path, std::uint64_t rights) const {
        const int descriptor = open(path.c_str(), O_PATH | O_CLOEXEC);
        if (descriptor < 0) return;
        struct stat about {};
        if (fstat(descriptor, &about) == 0 && !S_ISDIR(about.st_mode)) rights &= file_rights;
        landlock_path_beneath_attr rule{};
        rule.allowed_access = rights & m_rights;
        rule.parent_fd = descriptor;
        const long result = syscall(SYS_landlock_add_rule, m_descriptor, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
        close(descriptor);
        if (result != 0) fail_landlock(path.c_str());
    }

    void enforce() const {
        if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) fail_landlock("no_new_privs");
        if (syscall(SYS_landlock_restrict_self, m_descriptor, 0) != 0) fail_landlock("not enforced");
    }

  private:
    std::uint64_t m_rights;
    int m_descriptor = -1;
};

/// Libraries, drivers and what they read to find out about the machine.
void allow_system(const Ruleset& rules) {
    for (const char* path :
         {"/usr", "/lib", "/lib32", "/lib64", "/etc", "/sys", "/proc/self", "/proc/cpuinfo", "/proc/meminfo",
          "/proc/stat", "/proc/loadavg", "/proc/driver", "/proc/sys/vm", "/dev/zero", "/dev/urandom"})
        rules.allow(path, read_rights);
    rules.allow("/dev/null", device_rights);
    rules.allow("/dev/dri", device_rights);
    std::error_code ignored;
    for (const fs::directory_entry& device : fs::directory_iterator("/dev", ignored))
        if (device.path().filename().string().starts_with("nvidia")) rules.allow(device.path(), device_rights);
}

}  // namespace

std::string why_no_sandbox() {
    if (landlock_version() < 1) return fmt::format("the kernel has no Landlock ({})", std::strerror(errno));
    if (prctl(PR_GET_SECCOMP, 0, 0, 0, 0) < 0) return "the kernel has no seccomp";
    return "";
}

void confine_files(const OpenFiles& open) {
    const long version = landlock_version();
    if (version < 1) fail_landlock("not in this kernel");
    const Ruleset rules(version);
    allow_system(rules);
    for (const fs::path& path : open.read) rules.allow(path, read_rights);
    for (const fs::path& path : open.read_by_name) rules.allow(path, read_file_right);
    for (const fs::path& path : open.write) rules.allow(path, write_rights);
    rules.enforce();
}

}  // namespace sheer
