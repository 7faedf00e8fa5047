#include "renderer/report/frontier.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "renderer/number_text.h"
#include "renderer/report/measured.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* error_metric = "flip.mean";
constexpr double error_limits[] = {0.001, 0.01, 0.05};
constexpr double time_shares[] = {1, 0.5, 0.25};

struct Candidate {
    std::string label;
    double time_ms, error;
    json speedup;

    bool dominates(const Candidate& other) const {
        return time_ms <= other.time_ms && error <= other.error && (time_ms < other.time_ms || error < other.error);
    }
    std::string shown() const {
        std::string text =
            fmt::format("{} with an error of {} in {} ms", label, number_text(error, 2), number_text(time_ms));
        if (!speedup.is_object()) return text;
        text += fmt::format(", {:.2f} times the baseline's speed", speedup["value"].get<double>());
        const json& interval = speedup["ci95"];
        if (interval.is_array())
            text += fmt::format(" [{:.2f}, {:.2f}]", interval[0].get<double>(), interval[1].get<double>());
        return text;
    }
};

std::vector<Candidate> candidates(const json& run) {
    std::vector<Candidate> all;
    for (const json& result : run.at("results")) {
        const json time = measured(result, "timing.median"), error = measured(result, error_metric);
        if (time.is_number() && error.is_number()) all.push_back({result["label"], time, error, result["speedup"]});
    }
    std::ranges::stable_sort(all, {}, &Candidate::time_ms);
    return all;
}

/// Sentences of neighbouring limits with the same answer are one: the strictest limit is what counts.
class Sentences {
  public:
    void add(const std::string& condition, const Candidate& answer) {
        if (answer.label == m_last) return;
        m_last = answer.label;
        m_all.push_back(fmt::format("{}: {}.", condition, answer.shown()));
    }
    void begin_list() { m_last.clear(); }
    const json& all() const { return m_all; }

  private:
    std::string m_last;
    json m_all = json::array();
};

}  // namespace

json frontier(const json& run, const std::string& baseline) {
    const std::vector<Candidate> all = candidates(run);
    if (all.size() < 2) return nullptr;
    json methods = json::array(), dominated = json::array(), fastest = json::array(), closest = json::array();
    for (const Candidate& one : all) {
        const auto better = std::ranges::find_if(all, [&](const Candidate& other) { return other.dominates(one); });
        if (better == all.end()) {
            methods.push_back(one.label);
        } else {
            dominated.push_back({{"method", one.label}, {"by", better->label}});
        }
    }
    Sentences sentences;
    for (const double limit : error_limits) {
        const auto found = std::ranges::find_if(all, [&](const Candidate& one) { return one.error <= limit; });
        if (found == all.end()) continue;
        fastest.push_back({{"error", limit}, {"method", found->label}});
        sentences.add(fmt::format("Fastest under a mean FLIP error of {}", limit), *found);
    }
    sentences.begin_list();
    const auto base = std::ranges::find(all, baseline, &Candidate::label);
    for (const double share : time_shares) {
        if (base == all.end()) break;
        const double limit_ms = base->time_ms * share;
        const Candidate* best = nullptr;
        for (const Candidate& one : all)
            if (one.time_ms <= limit_ms && (!best || one.error < best->error)) best = &one;
        if (!best) continue;
        closest.push_back({{"time_ms", limit_ms}, {"method", best->label}});
        sentences.add(share == 1 ? fmt::format("Closest to the reference in no more time than {}", baseline)
                                 : fmt::format("Closest in {:g} of the time of {}", share, baseline),
                      *best);
    }
    return {{"error", error_metric},    {"methods", methods},        {"dominated", dominated},
            {"fastest_under", fastest}, {"closest_within", closest}, {"sentences", sentences.all()}};
}

}  // namespace sheer
