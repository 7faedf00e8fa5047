#include "renderer/report/timing.h"

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

double Timings::median_ms(const MethodResult& result) const {
    return median(times(result.samples));
}

json Timings::timing(const Samples& samples) const {
    const std::vector<double> chosen = times(samples);
    const Summary summary = summarize(chosen);
    std::vector<double> gpu, wall;
    std::size_t disagreeing = 0;
    for (const gl::FrameSample& sample : samples) {
        gpu.push_back(sample.gpu_ms);
        wall.push_back(sample.wall_ms);
        disagreeing += sample.valid ? 0 : 1;
    }
    return {{"unit", "ms"},
            {"clock", m_gpu_clock ? "gpu" : "wall"},
            {"samples", chosen},
            {"outliers", outliers(chosen)},
            {"median", summary.median},
            {"mad", summary.mad},
            {"min", summary.min},
            {"p95", summary.p95},
            {"ci95", pair_json(summary.ci95)},
            {"initialization", phase_median(samples, gl::Phase::initialization)},
            {"finalization", phase_median(samples, gl::Phase::finalization)},
            {"passes", passes(samples)},
            {"gpu_samples", gpu},
            {"wall_samples", wall},
            {"disagreeing_samples", disagreeing}};
}

json Timings::noise() const {
    const MethodResult* base = baseline();
    if (!base) return nullptr;
    const std::vector<double> again = times(m_run.baseline_again);
    const std::vector<double> ratios = paired_ratios(times(base->samples), again);
    if (ratios.empty()) return nullptr;
    const NoiseFloor noise = noise_floor(ratios);
    return {{"method", m_baseline},
            {"value", noise.value},
            {"ci95", pair_json(noise.ci95)},
            {"factor", noise.factor},
            {"samples", again}};
}

json Timings::speedup(const MethodResult& result) const {
    const MethodResult* base = baseline();
    if (!base || result.status != "ok") return nullptr;
    const std::vector<double> theirs = times(base->samples);
    const std::vector<double> ratios = paired_ratios(theirs, times(result.samples));
    if (ratios.empty()) return nullptr;
    const std::vector<double> noise_ratios = paired_ratios(theirs, times(m_run.baseline_again));
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
