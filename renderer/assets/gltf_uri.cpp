#include "renderer/assets/gltf_uri.h"

#include <array>
#include <cstdint>

#include "renderer/scene/assets.h"

namespace sheer {

namespace {

int hexadecimal_digit(char c) {
    const std::size_t value = std::string_view("0123456789abcdefABCDEF").find(c);
    return value == std::string_view::npos ? -1 : static_cast<int>(value < 16 ? value : value - 6);
}

constexpr std::string_view base64_alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string decode_base64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::array<int, 256> digits;
    digits.fill(-1);
    for (std::size_t i = 0; i < base64_alphabet.size(); ++i)
        digits[static_cast<unsigned char>(base64_alphabet[i])] = static_cast<int>(i);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const int digit = digits[static_cast<unsigned char>(c)];
        if (digit < 0) throw AssetError("a data: URI holds a character that is not base64");
        bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xffff;
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes += static_cast<char>(bits >> bit_count & 0xff);
    }
    return bytes;
}

}  // namespace

std::string percent_decoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && hexadecimal_digit(text[i + 1]) >= 0 &&
                            hexadecimal_digit(text[i + 2]) >= 0;
        decoded +=
            escape ? static_cast<char>(hexadecimal_digit(text[i + 1]) * 16 + hexadecimal_digit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return decoded;
}

std::optional<std::string> decode_data_uri(std::string_view uri) {
    if (!uri.starts_with("data:")) return std::nullopt;
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw AssetError("a data: URI has no comma before its data");
    const std::string_view kind = uri.substr(0, comma), data = uri.substr(comma + 1);
    if (!kind.ends_with(";base64")) return percent_decoded(data);
    return data.find('%') == std::string_view::npos ? decode_base64(data) : decode_base64(percent_decoded(data));
}

}  // namespace sheer
