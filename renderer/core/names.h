#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace sheer {

/// In ASCII lower case: ids are case-insensitive.
inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The entry with this `id`, or null.
template <typename Info>
const Info* find_by_id(const std::vector<Info>& all, const std::string& id) {
    const std::string wanted = lower_case(id);
    const auto found = std::ranges::find_if(all, [&](const Info& info) { return info.id == wanted; });
    return found == all.end() ? nullptr : &*found;
}

/// "a, b, c", for messages.
template <typename Info>
std::string joined_ids(const std::vector<Info>& all) {
    std::string text;
    for (const Info& info : all) text += (text.empty() ? "" : ", ") + info.id;
    return text;
}

}  // namespace sheer
