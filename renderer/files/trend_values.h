#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/results/quantity.h"

namespace sheer {

/// A number of a report that is followed over time.
struct TrendName {
    std::string point;   ///< of the sweep, as JSON text
    std::string method;  ///< label
    std::string metric;  ///< name of the quantity

    bool operator==(const TrendName&) const = default;
};

/// Numbers of a report, in the order of their names.
struct TrendValues {
    std::vector<TrendName> names;
    std::vector<Measured> values;  ///< NaN for a number that was not measured
};

/// Those of the first 64 points of a sweep.
TrendValues trend_values(const report::Report& report);

/// The names as JSON text, which the reports of one spec share, and back; empty for a text that is none.
std::string trend_names_text(const TrendValues& values);
std::vector<TrendName> trend_names(const std::string& text);
/// The numbers as bytes, and the one at `index` of them; nothing if it was not measured or is not there.
std::string trend_numbers(const TrendValues& values);
std::optional<Measured> trend_number(const std::string& numbers, std::size_t index);

}  // namespace sheer
