#pragma once
#include <nlohmann/json.hpp>

#include "renderer/compare.h"

namespace sheer {

/// The times of a run as its report says them: docs/measuring.md.
class Timings {
  public:
    /// `baseline` is a label of the spec. References outlive it.
    Timings(const Run& run, const std::string& baseline, bool software);

    /// A result's `timing`, with its `sort`. It must have samples.
    nlohmann::json timing(const MethodResult& result) const;
    /// The run's `noise_floor`: the baseline against its second instance. Null where the baseline did not run.
    nlohmann::json noise() const;
    /// A result's `speedup`: the baseline's time over the method's, round by round. Null where either did not run.
    nlohmann::json speedup(const MethodResult& result) const;
    /// The same where each frame of a method that sorts is preceded by its sort: `speedup_with_sort`.
    nlohmann::json speedup_with_sort(const MethodResult& result) const;
    /// Why a result has no speedup of either kind.
    std::string no_speedup_reason(const MethodResult& result) const;
    /// How many rounds the speedups need for an interval.
    std::size_t needed_rounds() const;
    /// Median time in ms.
    double median_ms(const MethodResult& result) const;

  private:
    /// In ms, by the clock that counts.
    std::vector<double> times(const std::vector<gl::FrameSample>& samples) const;
    nlohmann::json sort(const MethodResult& result) const;
    nlohmann::json judged(const MethodResult& result, bool with_sort) const;
    const MethodResult* baseline() const;
    std::string no_baseline_reason() const;

    const Run& m_run;
    const std::string& m_baseline;
    bool m_gpu_clock;
};

}  // namespace sheer
