#include "renderer/core/files.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "renderer/core/errors.h"

namespace sheer {

std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    errno = 0;
    std::string bytes;
    std::array<char, 65536> piece;
    while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
        bytes.append(piece.data(), static_cast<std::size_t>(file.gcount()));
        if (bytes.size() > max_bytes)
            throw std::runtime_error(fmt::format("{} has more than {} bytes", path.string(), max_bytes));
    }
    if (file.bad())
        throw std::system_error(errno == 0 ? EIO : errno, std::generic_category(), "cannot read " + path.string());
    return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw WriteError(errno == 0 ? EIO : errno, path.string());
}

}  // namespace sheer
