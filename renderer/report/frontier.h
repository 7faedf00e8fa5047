#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// Speed against error in one run: which methods are worth their time. Here, and nowhere else, it is decided what may
/// be called fastest; the terminal and the page show it.
///
/// A time is better where that is resolved as in Timings::speedup: against the baseline by the speedup's own verdict,
/// between two others by the ratios of their samples round by round. An error (flip.mean) is better where it is in the
/// digits shown. A method is dominated where another one is better in one of the two and it is better in none.
///
/// Returns {error, fastest: labels that may be called fastest, all resolved faster than the baseline and none of them
/// than another; methods: labels that are not dominated, fastest first; dominated: [{method, by, reason}];
/// fastest_under: [{error, method, tied: labels that `method` is not resolved from}], `method` null where nothing is
/// resolved; closest_within: [{speed, method, tied}]: of the baseline and what is resolved at least `speed` times as
/// fast, with its whole interval; sentences}. Null where fewer than two methods have both a time and an error.
nlohmann::json frontier(const nlohmann::json& run, const std::string& baseline);

}  // namespace sheer
