#include "server/process/memory_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sheer {

namespace {

[[noreturn]] void fail_memory_file(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

MemoryFile::MemoryFile(const char* name, const std::string& bytes)
    : m_descriptor(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
    if (m_descriptor < 0) fail_memory_file("memfd_create");
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = write(m_descriptor, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            const int error = errno;
            close(m_descriptor);
            errno = error;
            fail_memory_file("write to memory");
        }
        done += static_cast<std::size_t>(count);
    }
    // Neither side can change what the child reads.
    fcntl(m_descriptor, F_ADD_SEALS, F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE);
}

MemoryFile::~MemoryFile() {
    close(m_descriptor);
}

}  // namespace sheer
