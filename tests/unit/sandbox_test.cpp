// What a confined process can still do: its own work, and none of what would let it out.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/io_uring.h>
#include <linux/landlock.h>
#include <linux/perf_event.h>
#include <linux/sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "server/process/sandbox.h"
#include "tests/unit/temporary_folder.h"

namespace sheer::test::sandbox_test {

namespace {

namespace fs = std::filesystem;

/// A service's folder, with the archive, a picture, and the folders of two jobs of which one is the process's own.
struct Place {
    fs::path data;
    pid_t parent = getpid();

    std::string archive() const { return data / "archive.sqlite"; }
    std::string blob() const { return data / "blobs" / "picture"; }
    std::string out() const { return data / "scratch" / "own" / "out"; }
    std::string others() const { return data / "scratch" / "other" / "report.json"; }
    std::string in_proc(const char* name) const { return "/proc/" + std::to_string(parent) + "/" + name; }
};

/// Returns what a system call returns: -1 if it was refused.
struct Escape {
    const char* name;
    std::function<long(const Place& place)> attempt;
    bool works_unconfined = false;  ///< for anybody who owns the files, so that the test shows what it is worth
};

long read_of(const std::string& path) {
    return open(path.c_str(), O_RDONLY);
}

long write_of(const std::string& path) {
    return open(path.c_str(), O_WRONLY | O_CREAT, 0600);
}

long list_of(const std::string& path) {
    return open(path.c_str(), O_RDONLY | O_DIRECTORY);
}

long new_process(unsigned long flags) {
    const long pid = syscall(SYS_clone, flags | SIGCHLD, nullptr, nullptr, nullptr, nullptr);
    if (pid == 0) _exit(0);
    return pid;
}

template <std::size_t N>
long run_program(const char* const (&words)[N]) {
    return execv(words[0], const_cast<char* const*>(words));
}

std::vector<Escape> file_escapes() {
    return {
        {"read the archive", [](const Place& p) { return read_of(p.archive()); }, true},
        {"write to the archive", [](const Place& p) { return write_of(p.archive()); }, true},
        {"truncate the archive", [](const Place& p) { return static_cast<long>(truncate(p.archive().c_str(), 0)); },
         true},
        {"delete the archive", [](const Place& p) { return static_cast<long>(unlink(p.archive().c_str())); }, true},
        {"list the service's folder", [](const Place& p) { return list_of(p.data); }, true},
        {"list the pictures", [](const Place& p) { return list_of(p.data / "blobs"); }, true},
        {"write to a picture", [](const Place& p) { return write_of(p.blob()); }, true},
        {"delete a picture", [](const Place& p) { return static_cast<long>(unlink(p.blob().c_str())); }, true},
        {"take a picture away",
         [](const Place& p) { return static_cast<long>(rename(p.blob().c_str(), (p.out() + "/a").c_str())); }, true},
        {"add a picture", [](const Place& p) { return write_of(p.data / "blobs" / "new"); }, true},
        {"make a folder in the service's",
         [](const Place& p) { return static_cast<long>(mkdir((p.data / "new").c_str(), 0700)); }, true},
        {"read the output of another job", [](const Place& p) { return read_of(p.others()); }, true},
        {"leave the output folder upwards",
         [](const Place& p) { return read_of(p.out() + "/../../other/report.json"); }, true},
        {"read the archive by a symbolic link",
         [](const Place& p) {
             return symlink(p.archive().c_str(), (p.out() + "/link").c_str()) == 0 ? read_of(p.out() + "/link") : -1L;
         },
         true},
        {"link the archive into the output",
         [](const Place& p) { return static_cast<long>(link(p.archive().c_str(), (p.out() + "/hard").c_str())); },
         true},
        {"change the rights of the archive",
         [](const Place& p) { return static_cast<long>(chmod(p.archive().c_str(), 0666)); }, true},
        {"change the owner of the archive",
         [](const Place& p) { return static_cast<long>(chown(p.archive().c_str(), getuid(), getgid())); }, true},
        {"change the times of the archive",
         [](const Place& p) { return static_cast<long>(utimensat(AT_FDCWD, p.archive().c_str(), nullptr, 0)); }, true},
        {"set an attribute of the archive",
         [](const Place& p) { return static_cast<long>(setxattr(p.archive().c_str(), "user.a", "b", 1, 0)); }},
        {"write to /tmp", [](const Place&) { return static_cast<long>(open("/tmp", O_TMPFILE | O_WRONLY, 0600)); },
         true},
        {"write to /etc", [](const Place&) { return write_of("/etc/sheer-escape"); }},
        {"open a file by its handle",
         [](const Place&) { return syscall(SYS_open_by_handle_at, AT_FDCWD, nullptr, O_RDONLY); }},
        {"watch files", [](const Place&) { return syscall(SYS_inotify_init1, 0); }, true},
    };
}

std::vector<Escape> process_escapes() {
    return {
        {"start a shell",
         [](const Place&) {
             return run_program({"/bin/sh", "-c", "exit 0", nullptr});
         }},
        {"run a program of its own",
         [](const Place& p) {
             const std::string path = p.out() + "/program";
             std::ofstream(path) << "#!/bin/sh\nexit 0\n";
             return run_program({path.c_str(), nullptr});
         }},
        {"run a program in memory",
         [](const Place&) {
             const int file = memfd_create("program", 0);
             const char* const words[] = {"program", nullptr};
             return syscall(SYS_execveat, file, "", words, words + 1, AT_EMPTY_PATH);
         }},
        {"fork", [](const Place&) { return new_process(0); }, true},
        {"vfork", [](const Place&) { return new_process(CLONE_VFORK); }, true},
        {"clone3",
         [](const Place&) {
             clone_args arguments{};
             arguments.exit_signal = SIGCHLD;
             const long pid = syscall(SYS_clone3, &arguments, sizeof arguments);
             if (pid == 0) _exit(0);
             return pid;
         }},
        {"fork into namespaces", [](const Place&) { return new_process(CLONE_NEWUSER); }},
        {"look into another process", [](const Place& p) { return ptrace(PTRACE_SEIZE, p.parent, nullptr, nullptr); }},
        {"be looked into", [](const Place&) { return ptrace(PTRACE_TRACEME, 0, nullptr, nullptr); }, true},
        {"read another's memory",
         [](const Place& p) {
             char byte = 0;
             iovec here{&byte, 1}, there{&byte, 1};
             return static_cast<long>(process_vm_readv(p.parent, &here, 1, &there, 1, 0));
         }},
        {"write another's memory",
         [](const Place& p) {
             char byte = 0;
             iovec here{&byte, 1}, there{&byte, 1};
             return static_cast<long>(process_vm_writev(p.parent, &here, 1, &there, 1, 0));
         }},
        {"open another's memory", [](const Place& p) { return read_of(p.in_proc("mem")); }},
        {"read another's environment", [](const Place& p) { return read_of(p.in_proc("environ")); }, true},
        {"read another's memory map", [](const Place& p) { return read_of(p.in_proc("maps")); }, true},
        {"list processes", [](const Place&) { return list_of("/proc"); }, true},
        {"signal another process", [](const Place& p) { return static_cast<long>(kill(p.parent, 0)); }, true},
        {"signal every process", [](const Place&) { return static_cast<long>(kill(-1, 0)); }},
        {"signal another's thread", [](const Place& p) { return syscall(SYS_tgkill, p.parent, p.parent, 0); }, true},
        {"signal a thread by its number", [](const Place& p) { return syscall(SYS_tkill, p.parent, 0); }, true},
        {"queue a signal",
         [](const Place& p) {
             siginfo_t about{};
             about.si_code = SI_QUEUE;
             return syscall(SYS_rt_sigqueueinfo, p.parent, 0, &about);
         }},
        {"hold another process", [](const Place& p) { return syscall(SYS_pidfd_open, p.parent, 0); }, true},
        {"slow another process down",
         [](const Place& p) { return static_cast<long>(setpriority(PRIO_PROCESS, static_cast<id_t>(p.parent), 1)); }},
        {"move another process",
         [](const Place& p) {
             cpu_set_t all;
             CPU_ZERO(&all);
             CPU_SET(0, &all);
             return static_cast<long>(sched_setaffinity(p.parent, sizeof all, &all));
         }},
        {"raise a limit",
         [](const Place&) {
             const rlimit limit{1, 1};
             return static_cast<long>(setrlimit(RLIMIT_CORE, &limit));
         }},
        {"limit another process",
         [](const Place& p) {
             const rlimit limit{1, 1};
             return syscall(SYS_prlimit64, p.parent, RLIMIT_CORE, &limit, nullptr);
         }},
    };
}

std::vector<Escape> kernel_escapes() {
    return {
        {"open a TCP socket", [](const Place&) { return static_cast<long>(socket(AF_INET, SOCK_STREAM, 0)); }, true},
        {"open an IPv6 socket", [](const Place&) { return static_cast<long>(socket(AF_INET6, SOCK_DGRAM, 0)); }},
        {"open a local socket", [](const Place&) { return static_cast<long>(socket(AF_UNIX, SOCK_STREAM, 0)); }, true},
        {"open a netlink socket", [](const Place&) { return static_cast<long>(socket(AF_NETLINK, SOCK_RAW, 0)); },
         true},
        {"open a raw packet socket", [](const Place&) { return static_cast<long>(socket(AF_PACKET, SOCK_RAW, 0)); }},
        {"make a pair of sockets",
         [](const Place&) {
             int ends[2];
             return static_cast<long>(socketpair(AF_UNIX, SOCK_STREAM, 0, ends));
         },
         true},
        {"mount",
         [](const Place& p) { return static_cast<long>(mount("none", p.out().c_str(), "tmpfs", 0, nullptr)); }},
        {"open a tree of mounts", [](const Place& p) { return syscall(SYS_open_tree, AT_FDCWD, p.out().c_str(), 1); }},
        {"unmount", [](const Place& p) { return static_cast<long>(umount(p.out().c_str())); }},
        {"change the root", [](const Place& p) { return static_cast<long>(chroot(p.out().c_str())); }},
        {"pivot the root", [](const Place& p) { return syscall(SYS_pivot_root, p.out().c_str(), p.out().c_str()); }},
        {"leave its namespaces", [](const Place&) { return static_cast<long>(unshare(CLONE_NEWUSER)); }},
        {"enter a namespace", [](const Place&) { return static_cast<long>(setns(0, 0)); }},
        {"use io_uring",
         [](const Place&) {
             io_uring_params parameters{};
             return syscall(SYS_io_uring_setup, 1, &parameters);
         }},
        {"use BPF", [](const Place&) { return syscall(SYS_bpf, 0, nullptr, 0); }},
        {"use performance counters",
         [](const Place&) {
             perf_event_attr attributes{};
             return syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0);
         }},
        {"use userfaultfd", [](const Place&) { return syscall(SYS_userfaultfd, 0); }},
        {"use keys", [](const Place&) { return syscall(SYS_keyctl, 0, 0, 0, 0, 0); }},
        {"load a module", [](const Place&) { return syscall(SYS_init_module, nullptr, 0, nullptr); }},
        {"load a kernel", [](const Place&) { return syscall(SYS_kexec_load, 0, 0, nullptr, 0); }},
        {"restart the machine", [](const Place&) { return syscall(SYS_reboot, 0, 0, 0, nullptr); }},
        {"set the clock", [](const Place&) { return syscall(SYS_clock_settime, CLOCK_REALTIME, nullptr); }},
        {"rename the machine", [](const Place&) { return syscall(SYS_sethostname, nullptr, 0); }},
        {"read the kernel's log", [](const Place&) { return syscall(SYS_syslog, 10, nullptr, 0); }},
        {"become another user", [](const Place&) { return static_cast<long>(setuid(getuid())); }, true},
        {"take capabilities", [](const Place&) { return syscall(SYS_capset, nullptr, nullptr); }},
        {"loosen its execution domain", [](const Place&) { return syscall(SYS_personality, 0x0040000); }},
        {"lift the filter", [](const Place&) { return static_cast<long>(prctl(PR_SET_SECCOMP, 0, 0, 0, 0)); }},
        {"share memory", [](const Place&) { return syscall(SYS_shmget, 0, 4096, 01600); }, true},
        {"send messages", [](const Place&) { return syscall(SYS_msgget, 0, 01600); }, true},
        {"open ports of the machine", [](const Place&) { return syscall(SYS_ioperm, 0x80, 1, 1); }},
        {"make a device file",
         [](const Place& p) {
             return static_cast<long>(mknod((p.out() + "/device").c_str(), S_IFBLK | 0600, makedev(1, 0)));
         }},
        {"open the machine's memory", [](const Place&) { return read_of("/dev/mem"); }},
        {"open the kernel's messages", [](const Place&) { return read_of("/dev/kmsg"); }},
        {"open a terminal", [](const Place&) { return read_of("/dev/ptmx"); }, true},
        {"type into a terminal", [](const Place&) { return static_cast<long>(ioctl(2, TIOCSTI, "x")); }},
        {"take over a terminal", [](const Place&) { return static_cast<long>(ioctl(2, TIOCSCTTY, 1)); }},
    };
}

std::vector<Escape> all_escapes() {
    std::vector<Escape> all = file_escapes();
    for (const auto& more : {process_escapes(), kernel_escapes()}) all.insert(all.end(), more.begin(), more.end());
    return all;
}

constexpr int worked = 0, refused = 1, failed_otherwise = 2, not_confined = 3;

/// Whether the error is a refusal, not a complaint about what was passed. Not every machine has every device.
bool is_refusal(int error) {
    return error == EPERM || error == EACCES || error == ENOSYS || error == ENOENT;
}

class SandboxTest : public testing::Test {
  protected:
    SandboxTest() {
        if (!why_no_sandbox().empty()) m_lacking = why_no_sandbox();
        m_place.data = m_folder.path() / "data";
        for (const std::string& folder : {(m_place.data / "blobs").string(), (m_place.data / "assets").string(),
                                          m_place.out(), fs::path(m_place.others()).parent_path().string()})
            fs::create_directories(folder);
        for (const std::string& file : {m_place.archive(), m_place.blob(), m_place.others()})
            std::ofstream(file) << "text";
    }

    void SetUp() override {
        if (!m_lacking.empty()) GTEST_SKIP() << m_lacking;
    }

    /// The exit code of a process that is confined as a renderer is and does `work`, which returns its exit code.
    int code_of(bool confined, bool as_nobody, const std::function<int()>& work) {
        const pid_t child = fork();
        if (child == 0) {
            try {
                if (as_nobody && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(not_confined);
                if (confined) {
                    confine_files(
                        {.read_by_name = {m_place.data / "blobs", m_place.data / "assets"}, .write = {m_place.out()}});
                    confine_calls();
                }
            } catch (const SandboxError&) {
                _exit(not_confined);
            }
            _exit(work());
        }
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

    int attempt(const Escape& escape, bool confined, bool as_nobody) {
        return code_of(confined, as_nobody, [&] {
            errno = 0;
            if (escape.attempt(m_place) != -1) return worked;
            return is_refusal(errno) ? refused : failed_otherwise;
        });
    }

    static constexpr uid_t nobody = 65534;
    TemporaryFolder m_folder;
    Place m_place;
    std::string m_lacking;
};

TEST_F(SandboxTest, NoEscapeWorks) {
    for (const Escape& escape : all_escapes()) EXPECT_EQ(attempt(escape, true, false), refused) << escape.name;
    EXPECT_GE(all_escapes().size(), 47u);
}

TEST_F(SandboxTest, NorDoesOneAsAnotherUser) {
    if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
    fs::permissions(m_folder.path(), fs::perms::all);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(m_place.data)) {
        fs::permissions(entry.path(), fs::perms::all);
        EXPECT_EQ(chown(entry.path().c_str(), nobody, nobody), 0);
    }
    for (const Escape& escape : all_escapes()) EXPECT_EQ(attempt(escape, true, true), refused) << escape.name;
}

TEST_F(SandboxTest, WithoutItTheyWork) {
    for (const Escape& escape : all_escapes()) {
        if (!escape.works_unconfined) continue;
        for (const std::string& file : {m_place.archive(), m_place.blob(), m_place.others()})
            std::ofstream(file) << "text";
        fs::remove(m_place.out() + "/hard");
        fs::remove(m_place.out() + "/link");
        EXPECT_EQ(attempt(escape, false, false), worked) << escape.name << ": " << strerror(errno);
    }
}

TEST_F(SandboxTest, ItsOwnWorkIsNotDisturbed) {
    EXPECT_EQ(code_of(true, false,
                      [&] {
                          const std::string file = m_place.out() + "/report.json";
                          std::ofstream(file) << "done";
                          if (fs::file_size(file) != 4) return 11;
                          if (read_of(m_place.blob()) < 0) return 12;
                          if (read_of("/etc/passwd") < 0 || read_of("/proc/self/maps") < 0) return 13;
                          int sum = 0;
                          std::thread([&] { sum = 3; }).join();
                          if (sum != 3) return 14;
                          void* code = mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                                            MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                          if (code == MAP_FAILED) return 15;
                          fs::rename(file, m_place.out() + "/renamed");
                          fs::remove(m_place.out() + "/renamed");
                          return 0;
                      }),
              0);
    // It dies by what it does wrong, as without.
    EXPECT_EQ(code_of(true, false, []() -> int { std::abort(); }), 128 + SIGABRT);
}

}  // namespace

}  // namespace sheer::test::sandbox_test
