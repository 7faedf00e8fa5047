#include "renderer/report/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/number_text.h"
#include "renderer/report/measured.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

/// A value with the place it was measured at.
struct Sample {
    Measured measured;
    std::string where;
};

/// One trend of a suite, held against the runs.
class Trend {
  public:
    Trend(const json& trend, const json& runs)
        : m_trend(trend), m_runs(runs), m_metric(trend.at("metric").get<std::string>()) {}

    json judge() {
        const auto kind = m_trend.at("kind").get<std::string>();
        if (kind == "above") judge_above();
        if (kind == "grows") judge_growth();
        if (kind == "within") judge_range();
        std::string verdict = "not resolved";
        if (m_against > 0) {
            verdict = "fails";
        } else if (m_for > 0 && m_open == 0) {
            verdict = "holds";
        }
        return {{"text", m_trend.at("text")}, {"verdict", verdict}, {"detail", m_detail}};
    }

  private:
    /// The runs at the trend's points in its order; all runs where it names none.
    std::vector<const json*> runs() const {
        std::vector<const json*> found;
        const json points = m_trend.value("at", json::array({json::object()}));
        for (const json& point : points)
            for (const json& run : m_runs)
                if (lies_at(run["point"], point)) found.push_back(&run);
        return found;
    }

    std::optional<Measured> value(const json& run, const std::string& method) const {
        const json* result = find_result(run, method);
        return result ? measured_with_interval(*result, m_metric) : std::nullopt;
    }

    void note(bool holds, bool fails, const std::string& text) {
        (holds ? m_for : fails ? m_against : m_open) += 1;
        m_detail += (m_detail.empty() ? "" : "; ") + text;
    }

    static std::string place(const json& run) {
        const std::string point = describe_point(run["point"]);
        return point.empty() ? "" : " at " + point;
    }

    void judge_above() {
        const auto upper = m_trend.at("methods")[0].get<std::string>();
        const auto lower = m_trend.at("methods")[1].get<std::string>();
        for (const json* run : runs()) {
            const auto a = value(*run, upper), b = value(*run, lower);
            if (!a || !b) {
                note(false, false, "not measured" + place(*run));
            } else {
                note(a->low > b->high, a->high < b->low,
                     fmt::format("{} against {}{}", number_text(a->value), number_text(b->value), place(*run)));
            }
        }
    }

    /// From the first to the last value, with no step down that is resolved.
    void judge_growth() {
        std::vector<Measured> values;
        for (const json* run : runs()) {
            for (const auto& method : m_trend.at("methods")) {
                const auto found = value(*run, method);
                if (!found) return note(false, false, "not measured" + place(*run));
                values.push_back(*found);
            }
        }
        if (values.size() < 2) return note(false, false, "not measured at two points or more");
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
        for (const json* run : runs()) {
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
    const json& m_runs;
    const std::string m_metric;
    int m_for = 0, m_against = 0, m_open = 0;
    std::string m_detail;
};

json figure(const json& published, const json& runs) {
    json figure = {{"at", published.at("at")},
                   {"method", published.at("method")},
                   {"metric", published.at("metric")},
                   {"published", published.contains("value") ? published["value"] : published.at("range")},
                   {"measured", nullptr},
                   {"ci95", nullptr}};
    for (const json& run : runs) {
        if (!lies_at(run["point"], published.at("at"))) continue;
        const json* result = find_result(run, published.at("method"));
        const auto found = result ? measured_with_interval(*result, published.at("metric")) : std::nullopt;
        if (!found) continue;
        figure["measured"] = found->value;
        if (found->low != found->high && std::isfinite(found->low)) figure["ci95"] = {found->low, found->high};
    }
    return figure;
}

}  // namespace

json suite_report(const Suite& suite, const json& runs) {
    json figures = json::array(), trends = json::array();
    for (const json& published : suite.published) figures.push_back(figure(published, runs));
    for (const json& trend : suite.trends) trends.push_back(Trend(trend, runs).judge());
    return {{"id", suite.id},         {"title", suite.title}, {"source", suite.source},
            {"device", suite.device}, {"figures", figures},   {"trends", trends}};
}

}  // namespace sheer
