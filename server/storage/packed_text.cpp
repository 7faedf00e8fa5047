#include "server/storage/packed_text.h"

#include <zlib.h>

#include <cstdint>

#include "server/jobs/store_errors.h"

namespace sheer {

namespace {

constexpr std::size_t length_bytes = 8;

/// As pack_text(), so that unpack_text() reads it: zlib's level 0 keeps the bytes as they are.
std::string packed_at(int level, std::string_view text) {
    std::string packed;
    for (std::size_t i = 0; i < length_bytes; ++i)
        packed += static_cast<char>(std::uint64_t{text.size()} >> 8 * i & 0xff);
    uLongf size = compressBound(text.size());
    packed.resize(length_bytes + size);
    auto* const out = reinterpret_cast<Bytef*>(packed.data() + length_bytes);
    const auto* const in = reinterpret_cast<const Bytef*>(text.data());
    if (compress2(out, &size, in, text.size(), level) != Z_OK) throw StoreError("a text cannot be compressed");
    packed.resize(length_bytes + size);
    return packed;
}

}  // namespace

std::string pack_text(std::string_view text) {
    return packed_at(Z_DEFAULT_COMPRESSION, text);
}

std::string pack_numbers(std::string_view bytes) {
    std::string packed = packed_at(Z_DEFAULT_COMPRESSION, bytes);
    return packed.size() * 2 <= bytes.size() ? packed : packed_at(Z_NO_COMPRESSION, bytes);
}

std::string unpack_text(std::string_view packed, std::size_t max_bytes) {
    if (packed.size() < length_bytes) throw DamagedData("a compressed text is cut");
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < length_bytes; ++i)
        length |= std::uint64_t{static_cast<unsigned char>(packed[i])} << 8 * i;
    if (length > max_bytes) throw DamagedData("a compressed text is longer than the limit for reading");
    std::string text(length, '\0');
    uLongf size = text.size();
    const auto* const in = reinterpret_cast<const Bytef*>(packed.data() + length_bytes);
    auto* const out = reinterpret_cast<Bytef*>(text.data());
    if (uncompress(out, &size, in, packed.size() - length_bytes) != Z_OK || size != length)
        throw DamagedData("a compressed text is damaged");
    return text;
}

}  // namespace sheer
