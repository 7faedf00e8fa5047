#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/compare/compare.h"
#include "renderer/report/statistics.h"
#include "renderer/results/report.h"

namespace sheer {

/// The times of a run for its report: docs/measuring.md.
class Timings {
  public:
    /// `baseline` is a label of the spec. References must outlive it.
    Timings(const Run& run, const std::string& baseline, bool software);

    /// A result's `timing`, with its `sort`. It must have samples.
    report::Timing timing(const MethodResult& result) const;
    /// The run's `noise_floor`: the baseline compared with its second instance. None if the baseline did not run.
    std::optional<report::NoiseFloor> noise() const;
    /// A result's `speedup`: the baseline's time over the method's, round by round. None if either did not run.
    OrReason<report::Speedup> speedup(const MethodResult& result) const;
    /// The same, if each frame of a method that sorts includes the sort: `speedup_with_sort`.
    OrReason<report::Speedup> speedup_with_sort(const MethodResult& result) const;
    /// The time of the result from which `result.change` is measured, over its own.
    OrReason<report::Speedup> change(const MethodResult& result) const;
    /// The number of rounds that the speedups need for an interval.
    std::size_t needed_rounds() const;
    /// Median time in ms.
    double median_ms(const MethodResult& result) const;

  private:
    /// In ms, by the clock that is used.
    std::vector<double> times(const std::vector<gl::FrameSample>& samples) const;
    OrReason<report::TimeSummary> sort(const MethodResult& result) const;
    std::optional<report::Speedup> judged(const MethodResult& result, bool with_sort) const;
    /// `theirs` and `own` are times round by round; `compared` such comparisons are made together.
    std::optional<report::Speedup> judged(const std::vector<double>& theirs, const std::vector<double>& own,
                                          std::size_t compared, const std::optional<NoiseFloor>& noise) const;
    OrReason<report::Speedup> or_reason(std::optional<report::Speedup> speedup, const MethodResult& result) const;
    std::string no_speedup_reason(const MethodResult& result) const;
    const MethodResult* baseline() const;
    std::string no_baseline_reason() const;

    /// Of the last look at the samples.
    double error_rate() const { return error_rate_of_look(m_run.looks); }

    const Run& m_run;
    const std::string& m_baseline;
    bool m_gpu_clock;
};

}  // namespace sheer
