#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/assets/file_bytes.h"

namespace sheer {

/// Words between any of `separators`.
inline std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> words;
    std::size_t begin = text.find_first_not_of(separators);
    while (begin != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return words;
}

inline std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return result;
}

/// The whole word as a number. Returns whether it is one.
template <typename Number>
bool read_number(std::string_view word, Number& number) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

/// Throws AssetError for anything else in the NRRD field `field`.
template <typename Number>
Number number_in(std::string_view word, std::string_view field) {
    Number number{};
    if (!read_number(word, number))
        throw AssetError(fmt::format("the NRRD field \"{}\" holds \"{}\", which is not a valid number for it", field,
                                     printable(word)));
    return number;
}

/// Throws AssetError if there are not three.
template <typename Entry>
std::vector<Entry> three(std::vector<Entry> entries, std::string_view field) {
    if (entries.size() != 3)
        throw AssetError(fmt::format("the NRRD field \"{}\" must have three entries, not {}", field, entries.size()));
    return entries;
}

}  // namespace sheer
