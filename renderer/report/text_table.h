#pragma once
#include <string>
#include <vector>

namespace sheer {

using TableRow = std::vector<std::string>;

/// The rows as lines, the heading first: the first column is aligned left, the others right. A short row is a label
/// followed by a message. `rows` must not be empty.
std::string aligned(const std::vector<TableRow>& rows);

}  // namespace sheer
