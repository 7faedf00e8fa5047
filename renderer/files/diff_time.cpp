#include <fmt/format.h>

#include <limits>

#include "renderer/files/diff_parts.h"
#include "renderer/report/measured.h"
#include "renderer/report/two_samples.h"

namespace sheer {

using nlohmann::json;

namespace {

using Times = std::vector<double>;

json judged(const Speedup& speedup) {
    return {{"value", speedup.value},
            {"ci95", speedup.ci95 ? json{speedup.ci95->first, speedup.ci95->second} : json()},
            {"verdict", verdict_name(speedup.verdict)},
            {"reason", speedup.reason.empty() ? json() : json(speedup.reason)}};
}

/// How far a method is from itself within one report, as a factor.
double noise_factor(const json& run) {
    const json floor = run.value("noise_floor", json());
    if (!floor.is_object()) return 1;
    // JSON has no infinity: null stands for it.
    return floor.at("factor").is_number() ? floor["factor"].get<double>() : std::numeric_limits<double>::infinity();
}

/// The baseline's time over the method's, round by round; empty where the baseline did not run.
Times over_baseline(const json& run, const std::string& baseline, const json& result, const std::string& samples) {
    const json* base = find_result(run, baseline);
    if (!base || base->at("status") != "ok") return {};
    return paired_ratios(base->at("timing").at(samples).get<Times>(), result.at("timing").at(samples).get<Times>());
}

bool has_positive(const Times& times) {
    return std::ranges::any_of(times, [](double time) { return time > 0; });
}

/// What both ways of looking at the time agree on: {verdict, reason}.
std::pair<std::string, std::string> agreed(const json& absolute, const json& relative,
                                           const std::string& no_relative_reason) {
    const std::string of_time = absolute["verdict"];
    if (relative.is_null()) return {"not resolved", no_relative_reason};
    const std::string of_ratio = relative["verdict"];
    if (of_time == of_ratio)
        return {of_time, absolute["reason"].is_string() ? absolute["reason"].get<std::string>() : ""};
    if (of_ratio == "not resolved")
        return {of_ratio, "not against the baseline, so the machine may be " + of_time + " as a whole"};
    if (of_time == "not resolved") return {of_time, "only against the baseline, whose own time may have changed"};
    return {"not resolved", "the time and its ratio to the baseline's changed in opposite ways"};
}

}  // namespace

json time_diff(const RunPair& run, const json& result_a, const json& result_b) {
    const json &timing_a = result_a.at("timing"), &timing_b = result_b.at("timing");
    // Of two clocks only the one that both reports have is good for both.
    const bool same_clock = timing_a.at("clock") == timing_b.at("clock");
    const std::string samples = same_clock ? "samples" : "wall_samples";
    const Times a = timing_a.at(samples), b = timing_b.at(samples);
    json time = {{"clock", same_clock ? timing_a["clock"] : json("wall")}};
    for (const auto& [name, times] : {std::pair("a", a), std::pair("b", b)})
        time[name] = {{"median", times.empty() ? json() : json(median(times))}, {"samples", times.size()}};
    const bool measured = has_positive(a) && has_positive(b);
    const double noise = noise_factor(run.a) * noise_factor(run.b);
    time["absolute"] = measured ? judged(judge_two_samples(a, b, run.compared, noise)) : json();

    std::string no_relative_reason;
    time["relative"] = nullptr;
    const Times ratios_a = over_baseline(run.a, run.baseline_a, result_a, samples);
    const Times ratios_b = over_baseline(run.b, run.baseline_b, result_b, samples);
    if (run.baseline_a != run.baseline_b) {
        no_relative_reason = "the reports have different baselines";
    } else if (result_a.at("label") == run.baseline_a) {
        no_relative_reason = "it is the baseline: a slower machine looks the same as a slower method";
    } else if (!has_positive(ratios_a) || !has_positive(ratios_b)) {
        no_relative_reason = "the baseline did not run";
    } else {
        time["relative"] = judged(judge_two_samples(ratios_b, ratios_a, run.compared, noise));
    }
    if (!no_relative_reason.empty()) time["relative_reason"] = no_relative_reason;

    std::pair<std::string, std::string> verdict;
    if (!measured) {
        verdict = {"not resolved", "it took no time that the clock can tell"};
    } else if (run.same_device) {
        verdict = agreed(time["absolute"], time["relative"], no_relative_reason);
    } else {
        const json& reason = time["absolute"]["reason"];
        verdict = {time["absolute"]["verdict"], reason.is_string() ? reason.get<std::string>() : ""};
    }
    time["verdict"] = verdict.first;
    time["reason"] = verdict.second.empty() ? json() : json(verdict.second);
    return time;
}

}  // namespace sheer
