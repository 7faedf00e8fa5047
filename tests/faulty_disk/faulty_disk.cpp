// Put in front of the C library by LD_PRELOAD: the n-th call that writes to the file system of a folder fails, or kills
// its process. All processes with the same SHEER_FAULT_FILE count together, and the test arms the counter while they
// run.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>

namespace {

/// The file, as tests/soak/faults.test.mjs writes it.
struct Plan {
    std::atomic<std::int32_t> calls;  ///< so far
    std::atomic<std::int32_t> fails;  ///< the call that fails, from 1; 0 for none
    std::atomic<std::int32_t> error;  ///< errno, or 0 to kill the process
};

Plan* plan() {
    static Plan* const mapped = [] {
        const char* path = std::getenv("SHEER_FAULT_FILE");
        const int file = path ? static_cast<int>(open(path, O_RDWR | O_CLOEXEC)) : -1;
        if (file < 0) return static_cast<Plan*>(nullptr);
        void* memory = mmap(nullptr, sizeof(Plan), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        close(file);
        return memory == MAP_FAILED ? nullptr : static_cast<Plan*>(memory);
    }();
    return mapped;
}

/// The file system that fails. Files in memory, pipes and sockets are on others.
dev_t device() {
    static const dev_t found = [] {
        struct stat facts {};
        const char* folder = std::getenv("SHEER_FAULT_FOLDER");
        return folder && stat(folder, &facts) == 0 ? facts.st_dev : dev_t{0};
    }();
    return found;
}

// Before main, since a sandbox lets nobody open the file later.
[[gnu::constructor]] void prepare() {
    plan();
    device();
}

bool is_on_device(int file) {
    struct stat facts {};
    return fstat(file, &facts) == 0 && facts.st_dev == device() && (S_ISREG(facts.st_mode) || S_ISDIR(facts.st_mode));
}

/// Counts a call; true if it must fail, and then errno is set.
bool fails() {
    Plan* const shared = plan();
    if (!shared || ++shared->calls != shared->fails) return false;
    if (shared->error == 0) kill(getpid(), SIGKILL);
    errno = shared->error;
    return true;
}

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <typename Function, typename... Arguments>
auto write_to(const char* name, int file, Arguments... arguments) {
    static Function* const real = next<Function>(name);
    if (is_on_device(file) && fails()) return static_cast<decltype(real(file, arguments...))>(-1);
    return real(file, arguments...);
}

template <typename Function, typename... Arguments>
int change(const char* name, Arguments... arguments) {
    static Function* const real = next<Function>(name);
    return fails() ? -1 : real(arguments...);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
    using Write = ssize_t(int, const void*, size_t);
    return write_to<Write>("write", file, bytes, count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
    using Write = ssize_t(int, const void*, size_t, off_t);
    return write_to<Write>("pwrite", file, bytes, count, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
    using Write = ssize_t(int, const void*, size_t, off64_t);
    return write_to<Write>("pwrite64", file, bytes, count, at);
}

int fsync(int file) {
    return write_to<int(int)>("fsync", file);
}

int fdatasync(int file) {
    return write_to<int(int)>("fdatasync", file);
}

int ftruncate(int file, off_t size) {
    return write_to<int(int, off_t)>("ftruncate", file, size);
}

int ftruncate64(int file, off64_t size) {
    return write_to<int(int, off64_t)>("ftruncate64", file, size);
}

int fallocate(int file, int mode, off_t at, off_t size) {
    return write_to<int(int, int, off_t, off_t)>("fallocate", file, mode, at, size);
}

int posix_fallocate(int file, off_t at, off_t size) {
    static auto* const real = next<int(int, off_t, off_t)>("posix_fallocate");
    return is_on_device(file) && fails() ? errno : real(file, at, size);
}

int rename(const char* from, const char* to) {
    return change<int(const char*, const char*)>("rename", from, to);
}

int link(const char* from, const char* to) {
    return change<int(const char*, const char*)>("link", from, to);
}

int mkdir(const char* path, mode_t mode) {
    return change<int(const char*, mode_t)>("mkdir", path, mode);
}

}  // extern "C"
