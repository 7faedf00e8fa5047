#pragma once
#include <algorithm>
#include <string>

namespace sheer {

/// What is wrong with the name of a baseline, as the end of a sentence about it; "" if nothing is.
inline std::string wrong_baseline_name(const std::string& name) {
    const bool is_right = !name.empty() && name.size() <= 100 && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
               c == '-';
    });
    return is_right ? "" : "must have 1 to 100 letters, digits, dots, underscores and dashes";
}

}  // namespace sheer
