#include "renderer/report/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer {

std::string aligned(const std::vector<TableRow>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const TableRow& cells : rows) {
        if (cells.size() < widths.size()) widths[0] = std::max(widths[0], cells[0].size());
        for (std::size_t i = 0; cells.size() == widths.size() && i < cells.size(); ++i)
            widths[i] = std::max(widths[i], cells[i].size());
    }
    std::string text;
    for (const TableRow& cells : rows) {
        std::string line = fmt::format("{:<{}}", cells[0], widths[0]);
        for (std::size_t i = 1; i < cells.size(); ++i)
            line += fmt::format("  {:>{}}", cells[i], cells.size() == widths.size() ? widths[i] : 0);
        text += line + "\n";
    }
    return text;
}

}  // namespace sheer
