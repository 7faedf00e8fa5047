#pragma once
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

inline constexpr std::uintmax_t max_asset_file_bytes = std::uintmax_t{1} << 30;

/// The bytes of an untrusted file. Throws AssetError if it cannot be read, is empty, or has more than
/// max_asset_file_bytes.
std::string read_asset_bytes(const std::filesystem::path& file);

/// Text of a file for a message: at most `most_bytes`, with question marks for all but printable ASCII.
std::string printable(std::string_view text, std::size_t most_bytes = 40);

/// Reads numbers from untrusted bytes. Every read past the end throws AssetError.
class ByteReader {
  public:
    explicit ByteReader(std::string_view bytes, std::size_t position = 0) : m_bytes(bytes), m_position(position) {}

    std::size_t position() const { return m_position; }
    std::size_t left() const { return m_bytes.size() - m_position; }
    std::string_view take(std::size_t count);
    void skip(std::size_t count) { take(count); }
    std::uint8_t u8() { return static_cast<std::uint8_t>(take(1).front()); }
    std::uint16_t u16_big() { return static_cast<std::uint16_t>(big(2)); }
    std::uint32_t u32_big() { return big(4); }
    std::uint32_t u32_little();
    float f32_little() { return std::bit_cast<float>(u32_little()); }
    /// Up to the next zero byte, which is skipped.
    std::string_view zero_ended_text() { return take_to('\0'); }
    /// Up to the next `end`, which is skipped.
    std::string_view take_to(char end);

  private:
    std::uint32_t big(std::size_t count);

    std::string_view m_bytes;
    std::size_t m_position;
};

}  // namespace sheer
