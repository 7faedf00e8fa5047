#include "renderer/report/frontier.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "renderer/number_text.h"
#include "renderer/report/measured.h"
#include "renderer/report/statistics.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* error_metric = "flip.mean";
constexpr double error_limits[] = {0.001, 0.01, 0.05};
constexpr double least_speeds[] = {1, 2, 4};

struct Candidate {
    std::string label;
    double time_ms, error;
    json speedup;
    std::vector<double> samples;

    std::string shown_error() const { return number_text(error, 2); }
    bool is_nearer_than(const Candidate& other) const {
        return error < other.error && shown_error() != other.shown_error();
    }
    Verdict verdict() const {
        const std::string name = speedup.is_object() ? speedup.value("verdict", "") : "";
        for (const Verdict one : {Verdict::faster, Verdict::slower})
            if (name == verdict_name(one)) return one;
        return Verdict::not_resolved;
    }
    /// Whether its whole interval lies beyond a speed.
    bool is_beyond(double speed) const {
        return verdict() == Verdict::faster && speedup["ci95"].is_array() && speedup["ci95"][0] >= speed;
    }
    std::string shown() const {
        std::string text = fmt::format("{} with an error of {} in {} ms", label, shown_error(), number_text(time_ms));
        if (!speedup.is_object()) return text;
        text += fmt::format(", {:.2f} times the baseline's speed", speedup["value"].get<double>());
        const json& interval = speedup["ci95"];
        if (interval.is_array())
            text += fmt::format(" [{:.2f}, {:.2f}]", interval[0].get<double>(), interval[1].get<double>());
        return text;
    }
};
using Candidates = std::vector<Candidate>;

Candidates candidates(const json& run) {
    Candidates all;
    for (const json& result : run.at("results")) {
        const json time = measured(result, "timing.median"), error = measured(result, error_metric);
        if (!time.is_number() || !error.is_number()) continue;
        all.push_back({result["label"], time, error, result["speedup"],
                       result["timing"].value("samples", std::vector<double>())});
    }
    std::ranges::stable_sort(all, {}, &Candidate::time_ms);
    return all;
}

/// How far the baseline is from itself; none where that was not measured.
std::optional<NoiseFloor> noise_of(const json& run) {
    const json floor = run.value("noise_floor", json());
    if (!floor.is_object()) return std::nullopt;
    // JSON has no infinity: null stands for it.
    const json& factor = floor.at("factor");
    return NoiseFloor{1, {}, factor.is_number() ? factor.get<double>() : std::numeric_limits<double>::infinity()};
}

/// Which of two methods is faster.
class Race {
  public:
    Race(const json& run, const std::string& baseline) : m_baseline(baseline), m_noise(noise_of(run)) {}

    bool is_faster(const Candidate& one, const Candidate& other) const {
        if (other.label == m_baseline) return one.verdict() == Verdict::faster;
        if (one.label == m_baseline) return other.verdict() == Verdict::slower;
        const std::vector<double> ratios = paired_ratios(other.samples, one.samples);
        if (ratios.empty() || !one.speedup.is_object()) return false;
        return judge_speedup(ratios, one.speedup.value("compared", std::size_t{1}), m_noise).verdict == Verdict::faster;
    }

    /// "" where it is not dominated by the other.
    std::string why_dominated(const Candidate& one, const Candidate& by) const {
        if (is_faster(one, by) || one.is_nearer_than(by)) return "";
        if (is_faster(by, one)) return fmt::format("{} is resolved faster and no farther from the reference", by.label);
        if (by.is_nearer_than(one))
            return fmt::format("{} is nearer to the reference, and {} is not resolved faster", by.label, one.label);
        return "";
    }

    const std::string& baseline() const { return m_baseline; }

  private:
    const std::string& m_baseline;
    std::optional<NoiseFloor> m_noise;
};

/// A method and those that it ties with.
struct Winner {
    const Candidate* method = nullptr;
    std::vector<std::string> tied;
    bool is_resolved = false;  ///< it may be called fastest

    json to_json() const { return {{"method", method && is_resolved ? json(method->label) : json()}, {"tied", tied}}; }
};

/// Of `some`, from the least time on; one that is resolved faster than the baseline comes first.
Winner fastest_of(const std::vector<const Candidate*>& some, const Race& race) {
    Winner winner;
    const auto faster = std::ranges::find(some, Verdict::faster, [](const Candidate* one) { return one->verdict(); });
    winner.method = faster == some.end() ? some.front() : *faster;
    for (const Candidate* other : some)
        if (other != winner.method && !race.is_faster(*winner.method, *other)) winner.tied.push_back(other->label);
    winner.is_resolved = winner.method->verdict() != Verdict::not_resolved && winner.tied.size() + 1 < some.size();
    return winner;
}

/// Ties are those of the digits shown.
Winner closest_of(const std::vector<const Candidate*>& some) {
    Winner winner;
    for (const Candidate* one : some)
        if (!winner.method || one->is_nearer_than(*winner.method)) winner.method = one;
    for (const Candidate* one : some)
        if (one != winner.method && one->shown_error() == winner.method->shown_error())
            winner.tied.push_back(one->label);
    winner.is_resolved = true;
    return winner;
}

/// Sentences of neighbouring limits with the same answer are one: the strictest limit is what counts.
class Sentences {
  public:
    void add(const std::string& condition, const std::string& answer) {
        if (answer == m_last) return;
        m_last = answer;
        m_all.push_back(condition + answer);
    }
    void begin_list() { m_last.clear(); }
    const json& all() const { return m_all; }

  private:
    std::string m_last;
    json m_all = json::array();
};

class FrontierWriter {
  public:
    FrontierWriter(const json& run, const std::string& baseline)
        : m_run(run), m_all(candidates(run)), m_race(run, baseline) {}

    json write() {
        if (m_all.size() < 2) return nullptr;
        const json rounds = m_run.value("rounds", json::object());
        const bool too_few = rounds.contains("needed") && rounds["done"] < rounds["needed"];
        if (too_few)
            m_sentences.add("", fmt::format("No time is resolved, too few rounds: {}, needs {}.",
                                            rounds["done"].get<int>(), rounds["needed"].get<int>()));
        write_domination();
        for (const double limit : error_limits) write_fastest(limit, !too_few);
        m_sentences.begin_list();
        for (const double speed : least_speeds) write_closest(speed, !too_few);
        return {{"error", error_metric},         {"fastest", fastest()},       {"methods", m_methods},
                {"dominated", m_dominated},      {"fastest_under", m_fastest}, {"closest_within", m_closest},
                {"sentences", m_sentences.all()}};
    }

  private:
    std::vector<const Candidate*> those(const std::function<bool(const Candidate&)>& wanted) const {
        std::vector<const Candidate*> some;
        for (const Candidate& one : m_all)
            if (wanted(one)) some.push_back(&one);
        return some;
    }

    json fastest() const {
        const Winner winner = fastest_of(those([](const Candidate&) { return true; }), m_race);
        json labels = json::array();
        if (winner.method->verdict() != Verdict::faster) return labels;
        for (const Candidate& one : m_all) {
            const bool tied = std::ranges::find(winner.tied, one.label) != winner.tied.end();
            if (&one == winner.method || (tied && one.verdict() == Verdict::faster)) labels.push_back(one.label);
        }
        return labels;
    }

    void write_domination() {
        for (const Candidate& one : m_all) {
            std::string why;
            const auto by = std::ranges::find_if(m_all, [&](const Candidate& other) {
                why = &other == &one ? "" : m_race.why_dominated(one, other);
                return !why.empty();
            });
            if (by == m_all.end()) {
                m_methods.push_back(one.label);
            } else {
                m_dominated.push_back({{"method", one.label}, {"by", by->label}, {"reason", why}});
            }
        }
    }

    void write_fastest(double limit, bool in_words) {
        const auto some = those([&](const Candidate& one) { return one.error <= limit; });
        if (some.empty()) return;
        const Winner winner = fastest_of(some, m_race);
        json entry = winner.to_json();
        entry["error"] = limit;
        m_fastest.push_back(entry);
        if (!in_words) return;
        const std::string under = fmt::format("a mean FLIP error of {}", limit);
        const bool has_baseline = std::ranges::find(some, m_race.baseline(), &Candidate::label) != some.end();
        if (some.size() == 1) {
            m_sentences.add(fmt::format("Under {} there is only ", under), winner.method->shown() + ".");
        } else if (winner.is_resolved && winner.method->label != m_race.baseline()) {
            m_sentences.add(fmt::format("Fastest under {}: ", under), winner.method->shown() + ties(winner));
        } else if (has_baseline) {
            m_sentences.add(fmt::format("Under {} ", under),
                            fmt::format("no method is resolved faster than {}.", m_race.baseline()));
        } else {
            m_sentences.add(fmt::format("Under {}: ", under), winner.method->shown() + ties(winner));
        }
    }

    void write_closest(double speed, bool in_words) {
        const auto some = those([&](const Candidate& one) {
            return one.is_beyond(speed) || (speed == 1 && one.label == m_race.baseline());
        });
        if (some.empty()) return;
        const Winner winner = closest_of(some);
        json entry = winner.to_json();
        entry["speed"] = speed;
        m_closest.push_back(entry);
        if (!in_words) return;
        const std::string with =
            winner.tied.empty() ? "." : fmt::format("; as close: {}.", fmt::join(winner.tied, ", "));
        m_sentences.add(
            speed == 1
                ? fmt::format("Closest to the reference of {} and what is resolved faster: ", m_race.baseline())
                : fmt::format("Closest of what is resolved over {:g} times as fast as {}: ", speed, m_race.baseline()),
            winner.method->shown() + with);
    }

    static std::string ties(const Winner& winner) {
        return winner.tied.empty() ? "." : fmt::format("; not resolved from it: {}.", fmt::join(winner.tied, ", "));
    }

    const json& m_run;
    Candidates m_all;
    Race m_race;
    Sentences m_sentences;
    json m_methods = json::array(), m_dominated = json::array(), m_fastest = json::array(), m_closest = json::array();
};

}  // namespace

json frontier(const json& run, const std::string& baseline) {
    return FrontierWriter(run, baseline).write();
}

}  // namespace sheer
