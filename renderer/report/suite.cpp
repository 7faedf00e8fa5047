#include "renderer/report/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/core/number_text.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

/// A value and the point at which it was measured.
struct Sample {
    Measured measured;
    std::string where;
};

/// One trend of a suite, judged by the runs.
class Trend {
  public:
    Trend(const json& trend, const std::vector<report::Run>& runs)
        : m_trend(trend), m_runs(runs), m_quantity(find_quantity(trend.at("metric").get<std::string>())) {}

    report::Trend judge() {
        const auto kind = m_trend.at("kind").get<std::string>();
        if (kind == "above") judge_above();
        if (kind == "grows") judge_growth();
        if (kind == "within") judge_range();
        auto verdict = report::TrendVerdict::not_resolved;
        if (m_against > 0) {
            verdict = report::TrendVerdict::fails;
        } else if (m_for > 0 && m_open == 0) {
            verdict = report::TrendVerdict::holds;
        }
        return {m_trend.at("text"), m_detail, verdict};
    }

  private:
    /// The runs at the trend's points, in the trend's order; all runs if it names no points.
    std::vector<const report::Run*> runs() const {
        std::vector<const report::Run*> found;
        const json points = m_trend.value("at", json::array({json::object()}));
        for (const json& point : points)
            for (const report::Run& run : m_runs)
                if (lies_at(run.point, point)) found.push_back(&run);
        return found;
    }

    std::optional<Measured> value(const report::Run& run, const std::string& method) const {
        const report::Result* result = run.find(method);
        return result && m_quantity ? m_quantity->measure(*result) : std::nullopt;
    }

    void note(bool holds, bool fails, const std::string& text) {
        (holds ? m_for : fails ? m_against : m_open) += 1;
        m_detail += (m_detail.empty() ? "" : "; ") + text;
    }

    static std::string place(const report::Run& run) {
        const std::string point = describe_point(run.point);
        return point.empty() ? "" : " at " + point;
    }

    void judge_above() {
        const auto upper = m_trend.at("methods")[0].get<std::string>();
        const auto lower = m_trend.at("methods")[1].get<std::string>();
        for (const report::Run* run : runs()) {
            const auto a = value(*run, upper), b = value(*run, lower);
            if (!a || !b) {
                note(false, false, "not measured" + place(*run));
            } else {
                note(a->low > b->high, a->high < b->low,
                     fmt::format("{} compared with {}{}", number_text(a->value), number_text(b->value), place(*run)));
            }
        }
    }

    /// Rises from the first to the last value, with no resolved step down.
    void judge_growth() {
        std::vector<Measured> values;
        for (const report::Run* run : runs()) {
            for (const auto& method : m_trend.at("methods")) {
                const auto found = value(*run, method);
                if (!found) return note(false, false, "not measured" + place(*run));
                values.push_back(*found);
            }
        }
        if (values.size() < 2) return note(false, false, "measured at fewer than two points");
        std::string list;
        bool falls = false;
        for (std::size_t i = 0; i < values.size(); ++i) {
            list += (i == 0 ? "" : ", ") + number_text(values[i].value);
            falls = falls || (i > 0 && values[i].high < values[i - 1].low);
        }
        const bool grows = values.back().low > values.front().high;
        note(grows && !falls, falls || values.back().high < values.front().low, list);
    }

    void judge_range() {
        const double low = m_trend.at("range")[0], high = m_trend.at("range")[1];
        for (const report::Run* run : runs()) {
            for (const auto& method : m_trend.at("methods")) {
                const auto found = value(*run, method);
                if (!found) {
                    note(false, false, "not measured" + place(*run));
                    continue;
                }
                const bool inside = found->low >= low && found->high <= high;
                const bool outside = found->high < low || found->low > high;
                note(inside, outside, number_text(found->value) + place(*run));
            }
        }
    }

    const json& m_trend;
    const std::vector<report::Run>& m_runs;
    const Quantity* m_quantity;  ///< null if there is none with this name
    int m_for = 0, m_against = 0, m_open = 0;
    std::string m_detail;
};

report::Figure figure(const json& published, const std::vector<report::Run>& runs) {
    report::Figure figure{.at = published.at("at"),
                          .method = published.at("method"),
                          .metric = published.at("metric"),
                          .published = published.contains("value") ? published["value"] : published.at("range"),
                          .measured = {},
                          .ci95 = {}};
    const Quantity* quantity = find_quantity(figure.metric);
    for (const report::Run& run : runs) {
        const report::Result* result = lies_at(run.point, figure.at) ? run.find(figure.method) : nullptr;
        const auto found = result && quantity ? quantity->measure(*result) : std::nullopt;
        if (!found) continue;
        figure.measured = found->value;
        if (found->low != found->high && std::isfinite(found->low))
            figure.ci95 = report::Interval{found->low, found->high};
    }
    return figure;
}

}  // namespace

report::Suite suite_report(const Suite& suite, const std::vector<report::Run>& runs) {
    report::Suite made{suite.id, suite.title, suite.source, suite.device, {}, {}};
    for (const json& published : suite.published) made.figures.push_back(figure(published, runs));
    for (const json& trend : suite.trends) made.trends.push_back(Trend(trend, runs).judge());
    return made;
}

}  // namespace sheer
