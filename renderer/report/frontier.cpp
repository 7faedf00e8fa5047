#include "renderer/report/frontier.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "renderer/core/number_text.h"
#include "renderer/report/statistics.h"
#include "renderer/results/quantity.h"

namespace sheer {

namespace {

constexpr const char* error_metric = "flip.mean";
constexpr double error_limits[] = {0.001, 0.01, 0.05};
constexpr double least_speeds[] = {1, 2, 4};

struct Candidate {
    std::string label;
    double time_ms, error;
    std::optional<report::Speedup> speedup;
    std::vector<double> samples;
    std::optional<std::int64_t> memory_bytes;

    std::string shown_memory() const { return number_text(static_cast<double>(*memory_bytes) / (1 << 20), 2); }
    bool needs_less_than(const Candidate& other) const {
        return memory_bytes && other.memory_bytes && *memory_bytes < *other.memory_bytes &&
               shown_memory() != other.shown_memory();
    }
    std::string shown_error() const { return number_text(error, 2); }
    bool is_nearer_than(const Candidate& other) const {
        return error < other.error && shown_error() != other.shown_error();
    }
    Verdict verdict() const { return speedup ? speedup->verdict : Verdict::not_resolved; }
    /// Whether its whole interval is above a speed.
    bool is_beyond(double speed) const {
        return verdict() == Verdict::faster && speedup->ci95 && (*speedup->ci95)[0] >= speed;
    }
    std::string shown() const {
        std::string text = fmt::format("{} with an error of {} in {} ms", label, shown_error(), number_text(time_ms));
        if (!speedup) return text;
        text += fmt::format(", {:.2f} times the baseline's speed", speedup->value);
        if (speedup->ci95) text += fmt::format(" [{:.2f}, {:.2f}]", (*speedup->ci95)[0], (*speedup->ci95)[1]);
        return text;
    }
};
using Candidates = std::vector<Candidate>;

Candidates candidates(const report::Run& run) {
    const Quantity* quantity = find_quantity(error_metric);
    Candidates all;
    for (const report::Result& result : run.results) {
        const std::optional<double> error = quantity ? quantity->value(result) : std::nullopt;
        if (!result.timing || !error) continue;
        all.push_back({result.label, result.timing->median, *error, result.speedup.value, result.timing->samples,
                       result.memory_bytes});
    }
    std::ranges::stable_sort(all, {}, &Candidate::time_ms);
    return all;
}

/// How much the baseline differs from itself; none if that was not measured.
std::optional<NoiseFloor> noise_of(const report::Run& run) {
    if (!run.noise_floor) return std::nullopt;
    return NoiseFloor{1, {}, run.noise_floor->factor.value_or(std::numeric_limits<double>::infinity())};
}

/// Which of two methods is faster.
class Race {
  public:
    Race(const report::Run& run, const std::string& baseline)
        : m_baseline(baseline),
          m_noise(noise_of(run)),
          m_error_rate(error_rate_of_look(static_cast<int>(run.rounds.looks))) {}

    bool is_faster(const Candidate& one, const Candidate& other) const {
        if (other.label == m_baseline) return one.verdict() == Verdict::faster;
        if (one.label == m_baseline) return other.verdict() == Verdict::slower;
        const std::vector<double> ratios = paired_ratios(other.samples, one.samples);
        if (ratios.empty() || !one.speedup) return false;
        return judge_speedup(ratios, one.speedup->compared, m_noise, m_error_rate).verdict == Verdict::faster;
    }

    /// "" if the other one does not dominate it.
    std::string why_dominated(const Candidate& one, const Candidate& by) const {
        if (is_faster(one, by) || one.is_nearer_than(by) || one.needs_less_than(by)) return "";
        if (is_faster(by, one))
            return fmt::format("{} is resolved faster and not farther from the reference", by.label);
        if (by.is_nearer_than(one))
            return fmt::format("{} is nearer to the reference, and {} is not resolved faster", by.label, one.label);
        if (by.needs_less_than(one))
            return fmt::format("{} needs less memory, and {} is neither resolved faster nor nearer to the reference",
                               by.label, one.label);
        return "";
    }

    const std::string& baseline() const { return m_baseline; }

  private:
    const std::string& m_baseline;
    std::optional<NoiseFloor> m_noise;
    double m_error_rate;
};

/// A method and those with which it ties.
struct Winner {
    const Candidate* method = nullptr;
    std::vector<std::string> tied;
    bool is_resolved = false;  ///< it may be called fastest

    report::Winner told() const { return {method && is_resolved ? std::optional(method->label) : std::nullopt, tied}; }
};

/// The methods `some` by increasing time; those that are resolved faster than the baseline come first.
Winner fastest_of(const std::vector<const Candidate*>& some, const Race& race) {
    Winner winner;
    const auto faster = std::ranges::find(some, Verdict::faster, [](const Candidate* one) { return one->verdict(); });
    winner.method = faster == some.end() ? some.front() : *faster;
    for (const Candidate* other : some)
        if (other != winner.method && !race.is_faster(*winner.method, *other)) winner.tied.push_back(other->label);
    winner.is_resolved = winner.method->verdict() != Verdict::not_resolved && winner.tied.size() + 1 < some.size();
    return winner;
}

/// Errors tie if their shown digits are equal.
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

/// Amounts tie if their shown digits are equal.
Winner least_memory_of(const std::vector<const Candidate*>& some) {
    Winner winner;
    for (const Candidate* one : some)
        if (!winner.method || one->needs_less_than(*winner.method)) winner.method = one;
    for (const Candidate* one : some)
        if (one != winner.method && one->shown_memory() == winner.method->shown_memory())
            winner.tied.push_back(one->label);
    winner.is_resolved = true;
    return winner;
}

/// Sentences of neighboring limits with the same answer are merged into that of the strictest limit.
class Sentences {
  public:
    void add(const std::string& condition, const std::string& answer) {
        if (answer == m_last) return;
        m_last = answer;
        m_all.push_back(condition + answer);
    }
    void begin_list() { m_last.clear(); }
    const std::vector<std::string>& all() const { return m_all; }

  private:
    std::string m_last;
    std::vector<std::string> m_all;
};

class FrontierWriter {
  public:
    FrontierWriter(const report::Run& run, const std::string& baseline)
        : m_run(run), m_all(candidates(run)), m_race(run, baseline) {}

    std::optional<report::Frontier> write() {
        if (m_all.size() < 2) return std::nullopt;
        const report::Rounds& rounds = m_run.rounds;
        const bool too_few = rounds.done < rounds.needed;
        if (too_few)
            m_sentences.add(
                "", fmt::format("No time is resolved, too few rounds: {}, needs {}.", rounds.done, rounds.needed));
        write_domination();
        for (const double limit : error_limits) write_fastest(limit, !too_few);
        m_sentences.begin_list();
        for (const double speed : least_speeds) write_closest(speed, !too_few);
        m_sentences.begin_list();
        if (std::ranges::all_of(m_all, [](const Candidate& one) { return one.memory_bytes.has_value(); }))
            for (const double limit : error_limits) write_least_memory(limit);
        m_frontier.error = error_metric;
        m_frontier.fastest = fastest();
        m_frontier.sentences = m_sentences.all();
        return std::move(m_frontier);
    }

  private:
    std::vector<const Candidate*> those(const std::function<bool(const Candidate&)>& wanted) const {
        std::vector<const Candidate*> some;
        for (const Candidate& one : m_all)
            if (wanted(one)) some.push_back(&one);
        return some;
    }

    std::vector<std::string> fastest() const {
        const Winner winner = fastest_of(those([](const Candidate&) { return true; }), m_race);
        std::vector<std::string> labels;
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
                m_frontier.methods.push_back(one.label);
            } else {
                m_frontier.dominated.push_back({one.label, by->label, why});
            }
        }
    }

    void write_fastest(double limit, bool in_words) {
        const auto some = those([&](const Candidate& one) { return one.error <= limit; });
        if (some.empty()) return;
        const Winner winner = fastest_of(some, m_race);
        m_frontier.fastest_under.push_back({winner.told(), limit});
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
        m_frontier.closest_within.push_back({winner.told(), speed});
        if (!in_words) return;
        const std::string with =
            winner.tied.empty() ? "." : fmt::format("; as close: {}.", fmt::join(winner.tied, ", "));
        m_sentences.add(
            speed == 1
                ? fmt::format("Closest to the reference of {} and what is resolved faster: ", m_race.baseline())
                : fmt::format("Closest of what is resolved over {:g} times as fast as {}: ", speed, m_race.baseline()),
            winner.method->shown() + with);
    }

    void write_least_memory(double limit) {
        const auto some = those([&](const Candidate& one) { return one.error <= limit; });
        if (some.empty()) return;
        const Winner winner = least_memory_of(some);
        const std::int64_t bytes = *winner.method->memory_bytes;
        m_frontier.least_memory_under.push_back({winner.told(), limit, bytes});
        if (some.size() == 1) return;
        const std::string with =
            winner.tied.empty() ? "." : fmt::format("; as little: {}.", fmt::join(winner.tied, ", "));
        const std::string amount = bytes == 0 ? "none beside the picture" : winner.method->shown_memory() + " MiB";
        m_sentences.add(fmt::format("Least memory under a mean FLIP error of {}: ", limit),
                        fmt::format("{}, {}{}", winner.method->label, amount, with));
    }

    static std::string ties(const Winner& winner) {
        return winner.tied.empty() ? "." : fmt::format("; not resolved from it: {}.", fmt::join(winner.tied, ", "));
    }

    const report::Run& m_run;
    Candidates m_all;
    Race m_race;
    Sentences m_sentences;
    report::Frontier m_frontier;
};

}  // namespace

std::optional<report::Frontier> frontier(const report::Run& run, const std::string& baseline) {
    return FrontierWriter(run, baseline).write();
}

}  // namespace sheer
