#include "renderer/report/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sheer {

namespace {

using Samples = std::vector<gl::FrameSample>;

report::TimeSummary summary_of(const std::vector<double>& times, report::Clock clock, double error_rate) {
    const Summary summary = summarize(times, error_rate);
    return {.samples = times,
            .outliers = outliers(times),
            .median = summary.median,
            .mad = summary.mad,
            .min = summary.min,
            .p95 = summary.p95,
            .ci95 = interval_of(summary.ci95),
            .unit = "ms",
            .clock = clock};
}

bool gpu_clock_holds(const Samples& samples) {
    return std::ranges::all_of(samples, &gl::FrameSample::valid);
}

/// The GPU's clock leaves out the CPU's work between draws. A software rasteriser runs on the CPU, so for one, and if
/// the two clocks disagree, the fenced wall clock is used.
bool use_gpu_clock(const Run& run, bool software) {
    return !software && gpu_clock_holds(run.baseline_again) &&
           std::ranges::all_of(run.results, [](const MethodResult& result) { return gpu_clock_holds(result.samples); });
}

/// The median over the frames of the time in ms of the passes that `counts` selects; passes with the same name, such as
/// the tiles of a reference, are added up.
double median_of_passes(const Samples& samples, const std::function<bool(const gl::PassSample&)>& counts) {
    std::vector<double> sums;
    for (const gl::FrameSample& sample : samples) {
        double sum = 0;
        for (const gl::PassSample& pass : sample.passes)
            if (counts(pass)) sum += pass.gpu_ms;
        sums.push_back(sum);
    }
    return median(sums);
}

double phase_median(const Samples& samples, gl::Phase phase) {
    return median_of_passes(samples, [=](const gl::PassSample& pass) { return pass.phase == phase; });
}

std::vector<report::PassTime> passes(const Samples& samples) {
    std::vector<report::PassTime> all;
    for (const gl::PassSample& pass : samples.front().passes) {
        const auto of_name = [&](const gl::PassSample& other) { return other.name == pass.name; };
        if (std::ranges::find(all, pass.name, &report::PassTime::name) == all.end())
            all.push_back({pass.name, median_of_passes(samples, of_name)});
    }
    return all;
}

/// How many methods are compared with the baseline.
std::size_t compared_in(const Run& run) {
    const auto ran = std::ranges::count(run.results, report::ResultStatus::ok, &MethodResult::status);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(ran - 1, 1));
}

}  // namespace

Timings::Timings(const Run& run, const std::string& baseline, bool software)
    : m_run(run), m_baseline(baseline), m_gpu_clock(use_gpu_clock(run, software)) {}

std::vector<double> Timings::times(const Samples& samples) const {
    std::vector<double> all;
    for (const gl::FrameSample& sample : samples) all.push_back(m_gpu_clock ? sample.gpu_ms : sample.wall_ms);
    return all;
}

const MethodResult* Timings::baseline() const {
    const auto found = std::ranges::find_if(
        m_run.results, [&](const MethodResult& result) { return result.method.label == m_baseline; });
    return found == m_run.results.end() || found->status != report::ResultStatus::ok ? nullptr : &*found;
}

std::string Timings::no_baseline_reason() const {
    for (const MethodResult& result : m_run.results)
        if (result.method.label == m_baseline && result.status != report::ResultStatus::ok)
            return fmt::format("the baseline {} is {}: {}", m_baseline, word_of(result.status), result.reason);
    return "";
}

std::size_t Timings::needed_rounds() const {
    return rounds_needed(compared_in(m_run), error_rate());
}

double Timings::median_ms(const MethodResult& result) const {
    return median(times(result.samples));
}

OrReason<report::TimeSummary> Timings::sort(const MethodResult& result) const {
    if (result.sort_ms.empty()) return {{}, result.sorts ? m_run.no_sort_reason : "the method needs no sorting"};
    return {summary_of(result.sort_ms, report::Clock::wall, error_rate()), ""};
}

report::Timing Timings::timing(const MethodResult& result) const {
    const Samples& samples = result.samples;
    report::Timing timing{
        summary_of(times(samples), m_gpu_clock ? report::Clock::gpu : report::Clock::wall, error_rate())};
    timing.initialization = phase_median(samples, gl::Phase::initialization);
    timing.finalization = phase_median(samples, gl::Phase::finalization);
    timing.passes = passes(samples);
    for (const gl::FrameSample& sample : samples) {
        timing.gpu_samples.push_back(sample.gpu_ms);
        timing.wall_samples.push_back(sample.wall_ms);
        timing.disagreeing_samples += sample.valid ? 0 : 1;
    }
    if (result.clock.sm_mhz.empty()) {
        timing.gpu_clock_mhz.reason = "there is no NVML with this device";
    } else {
        timing.gpu_clock_mhz.value = result.clock.sm_mhz;
    }
    timing.retaken_samples = result.clock.retaken;
    timing.clock_lowered_by.assign(result.clock.lowered_by.begin(), result.clock.lowered_by.end());
    timing.sort = sort(result);
    return timing;
}

std::optional<report::NoiseFloor> Timings::noise() const {
    const MethodResult* base = baseline();
    if (!base) return std::nullopt;
    const std::vector<double> ratios = paired_ratios(times(base->samples), times(m_run.baseline_again));
    if (ratios.empty()) return std::nullopt;
    const NoiseFloor noise = noise_floor(ratios);
    return report::NoiseFloor{.method = m_baseline,
                              .value = noise.value,
                              .ci95 = interval_of(noise.ci95),
                              .factor = std::isfinite(noise.factor) ? std::optional(noise.factor) : std::nullopt,
                              .samples = ratios};
}

OrReason<report::Speedup> Timings::speedup(const MethodResult& result) const {
    return or_reason(judged(result, false), result);
}

OrReason<report::Speedup> Timings::speedup_with_sort(const MethodResult& result) const {
    const MethodResult* base = baseline();
    const auto is_untimed = [](const MethodResult& one) { return one.sorts && one.sort_ms.empty(); };
    const bool is_known = base && !is_untimed(*base) && !is_untimed(result);
    return or_reason(is_known ? judged(result, true) : std::nullopt, result);
}

OrReason<report::Speedup> Timings::or_reason(std::optional<report::Speedup> speedup, const MethodResult& result) const {
    if (speedup) return {std::move(speedup), ""};
    return {{}, no_speedup_reason(result)};
}

std::string Timings::no_speedup_reason(const MethodResult& result) const {
    if (result.status != report::ResultStatus::ok) return result.reason;
    std::string reason = no_baseline_reason();
    if (!reason.empty()) return reason;
    return judged(result, false) ? "sorting was not timed: " + m_run.no_sort_reason : "the method took no time";
}

std::optional<report::Speedup> Timings::judged(const MethodResult& result, bool with_sort) const {
    const MethodResult* base = baseline();
    if (!base || result.status != report::ResultStatus::ok) return std::nullopt;
    const auto taken = [&](const Samples& samples, const std::vector<double>& sort_ms) {
        std::vector<double> all = times(samples);
        for (std::size_t i = 0; with_sort && i < std::min(all.size(), sort_ms.size()); ++i) all[i] += sort_ms[i];
        return all;
    };
    const std::vector<double> theirs = taken(base->samples, base->sort_ms);
    const std::vector<double> noise_ratios =
        paired_ratios(theirs, taken(m_run.baseline_again, m_run.baseline_again_sort_ms));
    const std::optional<NoiseFloor> noise =
        noise_ratios.empty() ? std::nullopt : std::optional(noise_floor(noise_ratios));
    std::optional<report::Speedup> speedup =
        judged(theirs, taken(result.samples, result.sort_ms), compared_in(m_run), noise);
    if (speedup && &result == base) speedup->reason = "it is the baseline";
    return speedup;
}

std::optional<report::Speedup> Timings::judged(const std::vector<double>& theirs, const std::vector<double>& own,
                                               std::size_t compared, const std::optional<NoiseFloor>& noise) const {
    const std::vector<double> ratios = paired_ratios(theirs, own);
    if (ratios.empty()) return std::nullopt;
    const Speedup speedup = judge_speedup(ratios, compared, noise, error_rate());
    return report::Speedup{.value = speedup.value,
                           .ci95 = interval_of(speedup.ci95),
                           .verdict = speedup.verdict,
                           .reason = speedup.reason,
                           .compared = compared};
}

OrReason<report::Speedup> Timings::change(const MethodResult& result) const {
    const auto is_from = [&](const MethodResult& other) { return other.method.label == result.change->from; };
    const auto from = std::ranges::find_if(m_run.results, is_from);
    const auto changes =
        std::ranges::count_if(m_run.results, [](const MethodResult& one) { return one.change.has_value(); });
    const MethodResult* base = baseline();
    const std::vector<double> noise_ratios =
        base ? paired_ratios(times(base->samples), times(m_run.baseline_again)) : std::vector<double>();
    auto speedup = judged(times(from->samples), times(result.samples), static_cast<std::size_t>(changes),
                          noise_ratios.empty() ? std::nullopt : std::optional(noise_floor(noise_ratios)));
    if (!speedup) return {{}, "the method took no time"};
    return {std::move(speedup), ""};
}

}  // namespace sheer
