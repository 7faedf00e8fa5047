#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// Speed against error in one run: which methods are worth their time.
///
/// A method is dominated where another one is at least as fast and at least as close to the reference, and better in
/// one of the two (Pareto). Time is timing.median, the error flip.mean. Returns {error, methods: labels that are not
/// dominated, fastest first; dominated: [{method, by}]; fastest_under: [{error, method}]; closest_within: [{time_ms,
/// method}]; sentences}. Null where fewer than two methods have both a time and an error.
nlohmann::json frontier(const nlohmann::json& run, const std::string& baseline);

}  // namespace sheer
