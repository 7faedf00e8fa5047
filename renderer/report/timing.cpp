#include "renderer/report/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "renderer/report/statistics.h"

namespace sheer {

using nlohmann::json;

namespace {

using Samples = std::vector<gl::FrameSample>;

json pair_json(const std::optional<std::pair<double, double>>& interval) {
    return interval ? json{interval->first, interval->second} : json();
}

json summary_json(const std::vector<double>& times) {
    const Summary summary = summarize(times);
    return {{"samples", times},   {"outliers", outliers(times)}, {"median", summary.median},       {"mad", summary.mad},
            {"min", summary.min}, {"p95", summary.p95},          {"ci95", pair_json(summary.ci95)}};
}

bool gpu_clock_holds(const Samples& samples) {
    return std::ranges::all_of(samples, &gl::FrameSample::valid);
}

/// The GPU's clock leaves out what the CPU does between draws; a software rasteriser is the CPU, so there, and
/// wherever the two clocks disagree, the fenced wall clock is what counts.
bool use_gpu_clock(const Run& run, bool software) {
    return !software && gpu_clock_holds(run.baseline_again) &&
           std::ranges::all_of(run.results, [](const MethodResult& result) { return gpu_clock_holds(result.samples); });
}

/// The median over the frames of the time in ms that the passes took which `counts`; those of one name, such as the
/// tiles of a reference, are added up.
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

json passes(const Samples& samples) {
    json all = json::array();
    std::vector<std::string> names;
    for (const gl::PassSample& pass : samples.front().passes)
        if (std::ranges::find(names, pass.name) == names.end()) names.push_back(pass.name);
    for (const std::string& name : names) {
        const auto of_name = [&](const gl::PassSample& pass) { return pass.name == name; };
        all.push_back({{"name", name}, {"median", median_of_passes(samples, of_name)}});
    }
    return all;
}

/// How many methods are held against the baseline.
std::size_t compared_in(const Run& run) {
    const auto ran = std::ranges::count(run.results, "ok", &MethodResult::status);
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
    return found == m_run.results.end() || found->status != "ok" ? nullptr : &*found;
}

std::string Timings::no_baseline_reason() const {
    for (const MethodResult& result : m_run.results)
        if (result.method.label == m_baseline && result.status != "ok")
            return fmt::format("the baseline {} is {}: {}", m_baseline, result.status, result.reason);
    return "";
}

std::string Timings::no_speedup_reason(const MethodResult& result) const {
    if (result.status != "ok") return result.reason;
    const std::string reason = no_baseline_reason();
    if (!reason.empty()) return reason;
    return speedup(result).is_null() ? "the method took no time" : "sorting was not timed: " + m_run.no_sort_reason;
}

std::size_t Timings::needed_rounds() const {
    return rounds_needed(compared_in(m_run));
}

double Timings::median_ms(const MethodResult& result) const {
    return median(times(result.samples));
}

json Timings::sort(const MethodResult& result) const {
    if (result.sort_ms.empty()) return nullptr;
    json sort = summary_json(result.sort_ms);
    sort.update({{"unit", "ms"}, {"clock", "wall"}});
    return sort;
}

json Timings::timing(const MethodResult& result) const {
    const Samples& samples = result.samples;
    const std::vector<double> chosen = times(samples);
    std::vector<double> gpu, wall;
    std::size_t disagreeing = 0;
    for (const gl::FrameSample& sample : samples) {
        gpu.push_back(sample.gpu_ms);
        wall.push_back(sample.wall_ms);
        disagreeing += sample.valid ? 0 : 1;
    }
    json timing = summary_json(chosen);
    timing.update({{"unit", "ms"},
                   {"clock", m_gpu_clock ? "gpu" : "wall"},
                   {"initialization", phase_median(samples, gl::Phase::initialization)},
                   {"finalization", phase_median(samples, gl::Phase::finalization)},
                   {"passes", passes(samples)},
                   {"gpu_samples", gpu},
                   {"wall_samples", wall},
                   {"disagreeing_samples", disagreeing},
                   {"sort", sort(result)}});
    if (timing["sort"].is_null())
        timing["sort_reason"] = result.sorts ? m_run.no_sort_reason : "the method needs no sorting";
    return timing;
}

json Timings::noise() const {
    const MethodResult* base = baseline();
    if (!base) return nullptr;
    const std::vector<double> ratios = paired_ratios(times(base->samples), times(m_run.baseline_again));
    if (ratios.empty()) return nullptr;
    const NoiseFloor noise = noise_floor(ratios);
    return {{"method", m_baseline},
            {"value", noise.value},
            {"ci95", pair_json(noise.ci95)},
            {"factor", noise.factor},
            {"samples", ratios}};
}

json Timings::speedup(const MethodResult& result) const {
    return judged(result, false);
}

json Timings::speedup_with_sort(const MethodResult& result) const {
    const MethodResult* base = baseline();
    const auto is_untimed = [](const MethodResult& one) { return one.sorts && one.sort_ms.empty(); };
    if (!base || is_untimed(*base) || is_untimed(result)) return nullptr;
    return judged(result, true);
}

json Timings::judged(const MethodResult& result, bool with_sort) const {
    const MethodResult* base = baseline();
    if (!base || result.status != "ok") return nullptr;
    const auto taken = [&](const Samples& samples, const std::vector<double>& sort_ms) {
        std::vector<double> all = times(samples);
        for (std::size_t i = 0; with_sort && i < std::min(all.size(), sort_ms.size()); ++i) all[i] += sort_ms[i];
        return all;
    };
    const std::vector<double> theirs = taken(base->samples, base->sort_ms);
    const std::vector<double> ratios = paired_ratios(theirs, taken(result.samples, result.sort_ms));
    if (ratios.empty()) return nullptr;
    const std::vector<double> noise_ratios =
        paired_ratios(theirs, taken(m_run.baseline_again, m_run.baseline_again_sort_ms));
    const std::optional<NoiseFloor> noise =
        noise_ratios.empty() ? std::nullopt : std::optional(noise_floor(noise_ratios));
    const Speedup speedup = judge_speedup(ratios, compared_in(m_run), noise);
    const bool itself = &result == base;
    return {{"value", speedup.value},
            {"ci95", pair_json(speedup.ci95)},
            {"verdict", verdict_name(speedup.verdict)},
            {"reason", itself                   ? json("it is the baseline")
                       : speedup.reason.empty() ? json()
                                                : json(speedup.reason)},
            {"compared", compared_in(m_run)}};
}

}  // namespace sheer
