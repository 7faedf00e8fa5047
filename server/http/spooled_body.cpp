#include "server/http/spooled_body.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sheer::http {

namespace {

[[noreturn]] void fail(const char* doing) {
    throw std::system_error(errno, std::generic_category(), doing);
}

}  // namespace

SpooledBody::SpooledBody(const std::filesystem::path& folder, std::uint64_t& all_bytes) : m_all_bytes(all_bytes) {
    std::filesystem::create_directories(folder);
    std::string name = folder / "body-XXXXXX";
    m_file = mkostemp(name.data(), O_CLOEXEC);
    if (m_file < 0) fail("making a file for a body");
    unlink(name.c_str());
}

SpooledBody::~SpooledBody() {
    close(m_file);
    m_all_bytes -= m_bytes;
}

void SpooledBody::append(std::string_view piece) {
    while (!piece.empty()) {
        const ssize_t count = write(m_file, piece.data(), piece.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("writing a body");
        piece.remove_prefix(static_cast<std::size_t>(count));
        m_bytes += static_cast<std::uint64_t>(count);
        m_all_bytes += static_cast<std::uint64_t>(count);
    }
}

std::string SpooledBody::text() const {
    std::string text(m_bytes, '\0');
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t count = pread(m_file, text.data() + done, text.size() - done, static_cast<off_t>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("reading a body");
        if (count == 0) throw std::system_error(EIO, std::generic_category(), "reading a body");
        done += static_cast<std::size_t>(count);
    }
    return text;
}

}  // namespace sheer::http
