#pragma once
#include <optional>
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// Speed, error and memory in one run: which methods are worth their time. Only this code decides what may be called
/// fastest; the terminal and the page show its decision.
///
/// A time is better if that is resolved as in Timings::speedup: compared with the baseline by the speedup's own
/// verdict, between two others by the ratios of their samples round by round. An error (flip.mean) or a memory is
/// better if the shown digits are. A method is dominated if another one is better in one of the three and worse in
/// none.
///
/// A method may be called fastest if it is resolved faster than the baseline, and no other method is resolved faster
/// than it. The closest at a speed is chosen from the baseline and the methods that are resolved at least that fast,
/// with their whole interval. None if fewer than two methods have both a time and an error.
std::optional<report::Frontier> frontier(const report::Run& run, const std::string& baseline);

}  // namespace sheer
