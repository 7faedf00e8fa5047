#include "renderer/report/xml_text.h"

#include <cstdint>
#include <optional>

namespace sheer {

namespace {

constexpr std::string_view replacement_character = "\xEF\xBF\xBD";

/// What the first byte of a character means (RFC 3629).
struct Lead {
    std::size_t length;       ///< of the character, in bytes
    std::uint32_t bits;       ///< of its code point that are in this byte
    std::uint32_t least = 0;  ///< a smaller code point has a shorter form
};

std::optional<Lead> lead_of(unsigned char byte) {
    if (byte < 0x80) return Lead{1, byte, 0};
    if (byte >= 0xC0 && byte < 0xE0) return Lead{2, byte & 0x1Fu, 0x80};
    if (byte >= 0xE0 && byte < 0xF0) return Lead{3, byte & 0x0Fu, 0x800};
    if (byte >= 0xF0 && byte < 0xF8) return Lead{4, byte & 0x07u, 0x10000};
    return std::nullopt;
}

/// XML 1.0, fifth edition, production 2.
bool is_xml_character(std::uint32_t c) {
    return c == 0x9 || c == 0xA || c == 0xD || (c >= 0x20 && c <= 0xD7FF) || (c >= 0xE000 && c <= 0xFFFD) ||
           (c >= 0x10000 && c <= 0x10FFFF);
}

struct Character {
    std::size_t length = 1;  ///< in bytes
    bool is_good = false;    ///< it is valid UTF-8, and XML allows it
};

/// The first character of `text`.
Character first_character(std::string_view text) {
    const auto lead = lead_of(static_cast<unsigned char>(text[0]));
    if (!lead || text.size() < lead->length) return {};
    std::uint32_t number = lead->bits;
    for (std::size_t i = 1; i < lead->length; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xC0u) != 0x80) return {};
        number = number << 6 | (byte & 0x3Fu);
    }
    if (number < lead->least) return {};
    return {lead->length, is_xml_character(number)};
}

}  // namespace

std::string xml_text(std::string_view text) {
    std::string safe;
    while (!text.empty()) {
        const Character character = first_character(text);
        safe += character.is_good ? text.substr(0, character.length) : replacement_character;
        text.remove_prefix(character.length);
    }
    return safe;
}

}  // namespace sheer
