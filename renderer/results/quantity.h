#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/metrics/shared/metric.h"
#include "renderer/results/report.h"

namespace sheer {

/// A number and its uncertainty: low and high equal the number if it is exact, and are infinite if it should have an
/// interval but there are too few samples.
struct Measured {
    double value, low, high;
};

/// A number in a result of a report, and how it is shown. The tables of the page and of the terminal and the names that
/// checks accept all come from this list.
struct Quantity {
    enum class Table { none, times, speedups, sorting, fragments, differences };

    std::string name;           ///< its name in checks: timing.median, flip.mean, speedup
    std::string path;           ///< dotted, below a result of the report's JSON
    Table table = Table::none;  ///< of the page
    std::string head;           ///< of the page's column
    std::string unit;
    std::string summary;
    bool is_whole = false;    ///< a count
    bool is_timed = false;    ///< the methods that may be called fastest are marked in its column
    bool is_speedup = false;  ///< it is shown with its interval and verdict
    bool can_be_checked = true;
    bool has_interval = false;       ///< checks of it may be undecided
    std::optional<int> digits = {};  ///< significant digits of the smallest value in a column
    TerminalColumn terminal = {};    ///< of the terminal's tables
    std::function<std::optional<Measured>(const report::Result&)> measure;
    /// Why there is none; "" if the result does not say.
    std::function<std::string(const report::Result&)> reason;

    /// Only the number.
    std::optional<double> value(const report::Result& result) const;
    /// Why there is none; never empty.
    std::string no_value_reason(const report::Result& result) const;
};

/// Times, counts, memory, then the numbers of the metrics, in the order of their columns.
const std::vector<Quantity>& all_quantities();
/// Null if there is none with this name.
const Quantity* find_quantity(const std::string& name);
/// The names that a check may have.
std::vector<std::string> checkable_names();
/// Those that are columns of the page's tables of times and fragments, in this order; the columns of differences come
/// with the metrics.
std::vector<Quantity> time_and_fragment_columns();

template <>
struct Words<Quantity::Table> {
    using enum Quantity::Table;
    static constexpr std::pair<Quantity::Table, const char*> all[] = {
        {times, "times"}, {speedups, "speedups"}, {sorting, "sorting"}, {fragments, "fragments"}};
};

/// As a column of a table.
template <>
const Description<Quantity>& description_of();

}  // namespace sheer
