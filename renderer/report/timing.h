#pragma once
#include <nlohmann/json.hpp>

#include "renderer/compare.h"

namespace sheer {

/// The times of a run as its report says them: docs/measuring.md.
class Timings {
  public:
    /// `baseline` is a label of the spec. References outlive it.
    Timings(const Run& run, const std::string& baseline, bool software);

    /// A result's `timing`. `samples` must not be empty.
    nlohmann::json timing(const std::vector<gl::FrameSample>& samples) const;
    /// The run's `noise_floor`: the baseline against its second instance. Null where the baseline did not run.
    nlohmann::json noise() const;
    /// A result's `speedup`: the baseline's time over the method's, round by round. Null where either did not run.
    nlohmann::json speedup(const MethodResult& result) const;
    /// Median time in ms.
    double median_ms(const MethodResult& result) const;

  private:
    /// In ms, by the clock that counts.
    std::vector<double> times(const std::vector<gl::FrameSample>& samples) const;
    const MethodResult* baseline() const;

    const Run& m_run;
    const std::string& m_baseline;
    bool m_gpu_clock;
};

}  // namespace sheer
