#pragma once

namespace sheer {

/// Fractions of the job at which each stage begins, for the progress bar.
inline constexpr double references_begin = 0.05, methods_begin = 0.15, timing_begin = 0.3, counting_begin = 0.8,
                        metrics_begin = 0.9;

}  // namespace sheer
