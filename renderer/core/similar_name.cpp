#include "renderer/core/similar_name.h"

#include <algorithm>

#include "renderer/core/names.h"

namespace sheer {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            cost[i][j] =
                std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    return cost[a.size()][b.size()];
}

std::string similar_name(const std::string& word, const std::vector<std::string>& names) {
    const std::string wanted = lower_case(word);
    std::string best;
    // Of equally similar names, the one of the same length: letters are swapped more often than left out.
    std::pair<std::size_t, std::size_t> least{std::max<std::size_t>(1, wanted.size() / 3) + 1, 0};
    for (const std::string& name : names) {
        const bool is_beginning = wanted.size() > 1 && name.starts_with(wanted);
        const std::size_t distance = is_beginning ? 0 : edit_distance(wanted, lower_case(name));
        const std::size_t longer = std::max(name.size(), wanted.size()) - std::min(name.size(), wanted.size());
        if (std::pair(distance, longer) >= least) continue;
        least = {distance, longer};
        best = name;
    }
    return best;
}

}  // namespace sheer
