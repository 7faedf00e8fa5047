#include "server/http/answers.h"

namespace sheer {

namespace answer = http::answer;

template <>
const Description<answer::TrendLevel>& description_of() {
    using answer::TrendLevel;
    static const auto description =
        Description<TrendLevel>("SpecTrendLevel", "the values between two changes")
            .member(&TrendLevel::median, "median", "")
            .member(&TrendLevel::low, "low",
                    "median of the lower ends of the values' intervals; null if there are none")
            .member(&TrendLevel::high, "high", "median of the upper ends; null if there are none")
            .member(&TrendLevel::reports, "reports", "how many");
    return description;
}

template <>
const Description<answer::TrendValue>& description_of() {
    using answer::TrendValue;
    static const auto description =
        Description<TrendValue>("SpecTrendValue", "the value of a report")
            .member(&TrendValue::report, "report", "its id")
            .member(&TrendValue::created_at, "created_at", "UTC, RFC 3339")
            .member(&TrendValue::value, "value", "")
            .member(&TrendValue::low, "low",
                    "lower end of its interval, the value itself if it is exact; null if unknown")
            .member(&TrendValue::high, "high", "upper end");
    return description;
}

template <>
const Description<answer::TrendChange>& description_of() {
    using answer::TrendChange;
    static const auto description =
        Description<TrendChange>("SpecTrendChange", "where the level of the values changed")
            .member(&TrendChange::index, "index", "of the first value of the new level")
            .member(&TrendChange::before, "before", "id of the last report before")
            .member(&TrendChange::after, "after", "id of the first report after")
            .member(&TrendChange::level_before, "level_before", "")
            .member(&TrendChange::level_after, "level_after", "")
            .member(&TrendChange::p, "p", "how often a random order of the values looks changed as much");
    return description;
}

template <>
const Description<answer::Trend>& description_of() {
    using answer::Trend;
    static const auto description =
        Description<Trend>("SpecTrend", "a number of the reports of one spec over time")
            .member(&Trend::spec_sha256, "spec_sha256", "")
            .member(&Trend::device, "device", "name of the renderer")
            .member(&Trend::metric, "metric", "as checks name it")
            .member(&Trend::method, "method", "label of the method")
            .member(&Trend::point, "point", "point of the sweep, as JSON text")
            .member(&Trend::unit, "unit", "of the values; \"\" for none")
            .member(&Trend::values, "values", "oldest first")
            .member(
                &Trend::change_points, "change_points",
                "by E-divisive (Matteson and James 2014); where the values have intervals, those of both levels do not "
                "overlap")
            .member(&Trend::missing, "missing", "how many reports have no such value")
            .member(&Trend::metrics, "metrics", "those that can be asked for")
            .member(&Trend::methods, "methods", "those that can be asked for")
            .member(&Trend::points, "points", "those that can be asked for");
    return description;
}

}  // namespace sheer
