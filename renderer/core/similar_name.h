#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

/// How many letters have to be inserted, left out, replaced or swapped with their neighbour to turn one word into the
/// other (Damerau-Levenshtein, where no letter is changed twice).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that was probably meant by `word`; "" if none is similar.
std::string similar_name(const std::string& word, const std::vector<std::string>& names);

}  // namespace sheer
