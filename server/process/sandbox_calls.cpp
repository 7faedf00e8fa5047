#include <asm/ioctls.h>
#include <fmt/format.h>
#include <linux/sched.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <type_traits>

#include "server/process/sandbox.h"

namespace sheer {

namespace {

/// Without any condition: memory, threads of this process, clocks, and files as far as Landlock leaves them.
constexpr const char* harmless_calls[] = {
    // Memory.
    "brk", "mmap", "munmap", "mremap", "mprotect", "madvise", "mlock", "mlock2", "munlock", "mincore", "msync",
    "membarrier", "memfd_create", "get_mempolicy", "set_mempolicy", "mbind",
    // Threads.
    "futex", "futex_waitv", "set_robust_list", "rseq", "set_tid_address", "gettid", "getpid", "getppid", "getpgrp",
    "getpgid", "getsid", "exit", "exit_group", "sched_yield", "sched_getaffinity", "sched_getparam",
    "sched_getscheduler", "sched_getattr", "sched_get_priority_max", "sched_get_priority_min", "getpriority", "getcpu",
    "arch_prctl", "restart_syscall",
    // Its own signals.
    "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "rt_sigpending", "rt_sigsuspend", "rt_sigtimedwait",
    "sigaltstack", "pause", "alarm", "setitimer", "getitimer", "timer_create", "timer_settime", "timer_delete",
    "timer_gettime",
    // Time.
    "clock_gettime", "clock_getres", "clock_nanosleep", "nanosleep", "gettimeofday", "time", "times",
    // About itself and the machine.
    "getuid", "geteuid", "getgid", "getegid", "getgroups", "getresuid", "getresgid", "getrusage", "getrlimit", "uname",
    "sysinfo", "getrandom", "getcwd", "capget", "umask",
    // Files.
    "openat", "openat2", "open", "creat", "close", "close_range", "read", "write", "pread64", "pwrite64", "readv",
    "writev", "preadv", "pwritev", "preadv2", "pwritev2", "lseek", "fstat", "stat", "lstat", "newfstatat", "statx",
    "statfs", "fstatfs", "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getdents64", "getdents",
    "mkdir", "mkdirat", "unlink", "unlinkat", "rename", "renameat", "renameat2", "ftruncate", "fallocate", "fadvise64",
    "fsync", "fdatasync", "flock", "dup", "dup2", "dup3", "fcntl", "pipe", "pipe2", "poll", "ppoll", "select",
    "pselect6", "epoll_create1", "epoll_ctl", "epoll_wait", "epoll_pwait", "eventfd2", "timerfd_create",
    "timerfd_settime", "sendfile", "copy_file_range"};

using Filter = std::unique_ptr<std::remove_pointer_t<scmp_filter_ctx>, void (*)(scmp_filter_ctx)>;

void check_seccomp(int result, const char* what) {
    if (result < 0) throw SandboxError(fmt::format("seccomp: {}: {}", what, std::strerror(-result)));
}

template <typename... Conditions>
void on_call(const Filter& filter, std::uint32_t action, const char* name, Conditions... conditions) {
    const int number = seccomp_syscall_resolve_name(name);
    // Calls that this architecture does not have.
    if (number == __NR_SCMP_ERROR || number < 0) return;
    check_seccomp(seccomp_rule_add(filter.get(), action, number, sizeof...(conditions), conditions...), name);
}

template <typename... Conditions>
void allow_call(const Filter& filter, const char* name, Conditions... conditions) {
    on_call(filter, SCMP_ACT_ALLOW, name, conditions...);
}

}  // namespace

void confine_calls() {
    const Filter filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)), [](scmp_filter_ctx context) { seccomp_release(context); });
    if (!filter) throw SandboxError("seccomp: there is no memory for a filter");
    check_seccomp(seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1), "not for all threads");
    for (const char* name : harmless_calls) allow_call(filter, name);
    // Threads, but no processes. The flags of clone3 are in memory, where a filter cannot see them; the C library falls
    // back to clone if there is none.
    allow_call(filter, "clone", SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
    on_call(filter, SCMP_ACT_ERRNO(ENOSYS), "clone3");
    // Signals to itself, as abort() sends one.
    const auto self = static_cast<scmp_datum_t>(getpid());
    for (const char* name : {"kill", "tgkill"}) allow_call(filter, name, SCMP_A0(SCMP_CMP_EQ, self));
    for (const int option : {PR_SET_NAME, PR_GET_NAME, PR_GET_DUMPABLE, PR_SET_TIMERSLACK, PR_GET_TIMERSLACK})
        allow_call(filter, "prctl", SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(option)));
    // Only asking for limits: with no new value.
    allow_call(filter, "prlimit64", SCMP_A2(SCMP_CMP_EQ, 0));
    // Of its own threads only.
    for (const char* name : {"sched_setaffinity", "sched_setscheduler"})
        allow_call(filter, name, SCMP_A0(SCMP_CMP_EQ, 0));
    allow_call(filter, "setpriority", SCMP_A1(SCMP_CMP_EQ, 0));
    // Drivers need ioctl. The low numbers belong to terminals, such as typing into that of whoever started the service.
    allow_call(filter, "ioctl", SCMP_A1_32(SCMP_CMP_EQ, TCGETS));
    allow_call(filter, "ioctl", SCMP_A1_32(SCMP_CMP_GT, TIOCLINUX));
    check_seccomp(seccomp_load(filter.get()), "not enforced");
}

}  // namespace sheer
