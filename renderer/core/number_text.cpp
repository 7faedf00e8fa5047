#include "renderer/core/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace sheer {

namespace {

constexpr double least_in_plain = 1e-9, most_in_plain = 1e15;

bool is_plain(double value) {
    return value == 0 || (std::abs(value) >= least_in_plain && std::abs(value) < most_in_plain);
}

std::string without_trailing_zeros(std::string text) {
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

}  // namespace

std::string number_text(double value, int digits) {
    if (!is_plain(value)) return fmt::format("{:.{}g}", value, digits);
    const int before_point = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    return without_trailing_zeros(fmt::format("{:.{}f}", value, std::max(0, digits - before_point)));
}

std::string number_text_beside(double value, double limit) {
    if (value == limit) return full_number_text(value);
    for (int digits = 3; digits < std::numeric_limits<double>::max_digits10; ++digits) {
        const std::string text = number_text(value, digits);
        const double shown = std::stod(text);
        if (shown != limit && (shown < limit) == (value < limit)) return text;
    }
    return full_number_text(value);
}

std::string full_number_text(double value) {
    std::array<char, 64> text;
    const auto format = is_plain(value) ? std::chars_format::fixed : std::chars_format::general;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format).ptr;
    return {text.data(), end};
}

}  // namespace sheer
