#include "renderer/assets/file_bytes.h"

#include <fmt/format.h>

#include <fstream>

namespace sheer {

std::string read_asset_bytes(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) throw AssetError("the file cannot be read: " + error.message());
    if (size == 0) throw AssetError("the file is empty");
    if (size > max_asset_file_bytes)
        throw AssetError(fmt::format("the file has {} bytes; at most {} are read", size, max_asset_file_bytes));
    std::string bytes(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) throw AssetError("the file cannot be read");
    return bytes;
}

std::string printable(std::string_view text, std::size_t most_bytes) {
    std::string result(text.substr(0, most_bytes));
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return result;
}

std::string_view ByteReader::take(std::size_t count) {
    if (count > left()) throw AssetError("the file ends too early");
    const std::string_view taken = m_bytes.substr(m_position, count);
    m_position += count;
    return taken;
}

std::uint32_t ByteReader::big(std::size_t count) {
    std::uint32_t value = 0;
    for (const char byte : take(count)) value = value << 8 | static_cast<std::uint8_t>(byte);
    return value;
}

std::uint32_t ByteReader::u32_little() {
    std::uint32_t value = 0;
    const std::string_view taken = take(4);
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(taken[i]);
    return value;
}

std::string_view ByteReader::take_to(char end) {
    const std::size_t found = m_bytes.find(end, m_position);
    if (found == std::string_view::npos) throw AssetError("the file ends too early");
    const std::string_view text = take(found - m_position);
    skip(1);
    return text;
}

}  // namespace sheer
