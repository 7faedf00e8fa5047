#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "renderer/diff/diff_parts.h"
#include "renderer/report/two_samples.h"

namespace sheer {

using report::SpeedVerdict;

namespace {

using Times = std::vector<double>;

diff::Judged judged(const Speedup& speedup) {
    return {.value = speedup.value,
            .ci95 = interval_of(speedup.ci95),
            .verdict = speedup.verdict,
            .reason = speedup.reason};
}

/// How much a method differs from itself within one report, as a factor.
double noise_factor(const report::Run& run) {
    if (!run.noise_floor) return 1;
    return run.noise_floor->factor.value_or(std::numeric_limits<double>::infinity());
}

/// The times of both reports by one clock.
using Samples = const Times& (*)(const report::Timing&);

/// The baseline's time over the method's, round by round; empty if the baseline did not run.
Times over_baseline(const report::Run& run, const std::string& baseline, const report::Timing& timing,
                    Samples samples) {
    const report::Result* base = run.find(baseline);
    if (!base || base->status != report::ResultStatus::ok || !base->timing) return {};
    return paired_ratios(samples(*base->timing), samples(timing));
}

bool has_positive(const Times& times) {
    return std::ranges::any_of(times, [](double time) { return time > 0; });
}

diff::TimesOf times_of(const Times& times) {
    return {times.empty() ? std::nullopt : std::optional(median(times)), times.size()};
}

struct TimeVerdict {
    SpeedVerdict verdict = SpeedVerdict::not_resolved;
    std::string reason;
};

/// The verdict, if the time and its ratio to the baseline's agree.
TimeVerdict agreed(const diff::Judged& absolute, const OrReason<diff::Judged>& relative) {
    constexpr SpeedVerdict unresolved = SpeedVerdict::not_resolved;
    if (!relative) return {unresolved, relative.reason};
    if (absolute.verdict == relative->verdict) return {absolute.verdict, absolute.reason};
    if (relative->verdict == unresolved)
        return {unresolved,
                "not compared with the baseline, so the machine may be " + word_of(absolute.verdict) + " as a whole"};
    if (absolute.verdict == unresolved)
        return {unresolved, "only compared with the baseline, whose own time may have changed"};
    return {unresolved, "the time and its ratio to the baseline's changed in opposite directions"};
}

}  // namespace

std::optional<diff::TimeDiff> time_diff(const RunPair& run, const report::Result& result_a,
                                        const report::Result& result_b) {
    if (!result_a.timing || !result_b.timing) return std::nullopt;
    const report::Timing &timing_a = *result_a.timing, &timing_b = *result_b.timing;
    // If the clocks differ, the one that both reports have is used.
    const bool same_clock = timing_a.clock == timing_b.clock;
    const Samples samples = same_clock
                                ? Samples([](const report::Timing& t) -> const Times& { return t.samples; })
                                : Samples([](const report::Timing& t) -> const Times& { return t.wall_samples; });
    const Times &a = samples(timing_a), &b = samples(timing_b);
    diff::TimeDiff time;
    time.clock = same_clock ? timing_a.clock : report::Clock::wall;
    time.a = times_of(a);
    time.b = times_of(b);
    const double noise = noise_factor(run.a) * noise_factor(run.b);
    if (has_positive(a) && has_positive(b)) time.absolute = judged(judge_two_samples(a, b, run.compared, noise));

    const Times ratios_a = over_baseline(run.a, run.baseline_a, timing_a, samples);
    const Times ratios_b = over_baseline(run.b, run.baseline_b, timing_b, samples);
    if (run.baseline_a != run.baseline_b) {
        time.relative.reason = "the reports have different baselines";
    } else if (result_a.label == run.baseline_a) {
        time.relative.reason = "it is the baseline: a slower machine looks the same as a slower method";
    } else if (!has_positive(ratios_a) || !has_positive(ratios_b)) {
        time.relative.reason = "the baseline did not run";
    } else {
        time.relative.value = judged(judge_two_samples(ratios_b, ratios_a, run.compared, noise));
    }

    TimeVerdict verdict{.reason = "its time was too short for the clock"};
    if (time.absolute)
        verdict = run.same_device ? agreed(*time.absolute, time.relative)
                                  : TimeVerdict{time.absolute->verdict, time.absolute->reason};
    time.verdict = verdict.verdict;
    time.reason = verdict.reason;
    return time;
}

}  // namespace sheer
