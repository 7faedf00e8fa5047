#pragma once
#include <string>
#include <vector>

namespace sheer {

using TableRow = std::vector<std::string>;

/// The rows as lines, the first one the head: the first column to the left, the others to the right. A short row is a
/// message after its label. `rows` must not be empty.
std::string aligned(const std::vector<TableRow>& rows);

}  // namespace sheer
