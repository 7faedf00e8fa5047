#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/core/clock.h"
#include "renderer/files/trend_values.h"
#include "renderer/report/change_points.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr int most_reports = 10'000;
constexpr std::size_t longest_name_bytes = 200;

/// Reports that were made before numbers were kept are read once.
void complete(Service& service, TrendReport& report) {
    if (report.numbers) return;
    const auto record = service.store.reports().find(report.id);
    if (!record || record->status != Status::done) return;
    try {
        const TrendValues values = trend_values(report_of(*record));
        report.numbers = ReportNumbers{trend_names_text(values), trend_numbers(values)};
        service.store.trends().keep(report.id, *report.numbers);
    } catch (const DamagedData&) {
        return;
    }
}

/// The names of the newest report, which the others of the spec share unless an older version made them.
std::vector<TrendName> names_of(const std::vector<TrendReport>& reports) {
    for (auto report = reports.rbegin(); report != reports.rend(); ++report)
        if (report->numbers) return trend_names(report->numbers->names);
    return {};
}

template <typename Member>
std::vector<std::string> different(const std::vector<TrendName>& names, Member member) {
    std::vector<std::string> all;
    for (const TrendName& name : names)
        if (std::ranges::find(all, name.*member) == all.end()) all.push_back(name.*member);
    return all;
}

/// `wanted`, or the first choice if it is "". Throws Problem (400).
std::string chosen(const std::string& wanted, const std::vector<std::string>& choices, const char* field) {
    if (choices.empty() || wanted.empty()) return choices.empty() ? wanted : choices.front();
    if (std::ranges::find(choices, wanted) != choices.end()) return wanted;
    throw Problem(400, "The query is wrong.",
                  {{fmt::format("/{}", field), fmt::format("the reports of this spec have no \"{}\"", wanted)}});
}

/// The numbers with one name, from reports whose names may differ.
class NumberFinder {
  public:
    explicit NumberFinder(TrendName name) : m_name(std::move(name)) {}

    std::optional<Measured> find(const ReportNumbers& numbers) {
        if (numbers.names != m_names) {
            m_names = numbers.names;
            const std::vector<TrendName> all = trend_names(numbers.names);
            m_index = static_cast<std::size_t>(std::ranges::find(all, m_name) - all.begin());
        }
        return trend_number(numbers.numbers, m_index);
    }

  private:
    const TrendName m_name;
    std::string m_names;
    std::size_t m_index = 0;
};

answer::TrendLevel told_level(const Level& level) {
    const auto end = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
    return {level.median, end(level.low), end(level.high), level.end - level.begin};
}

ListFilter filter_of_trend(Service& service, const Request& request) {
    ListFilter filter{.tags = request.query["tag"], .spec_sha256 = request.query["spec_sha256"]};
    filter.device = request.query["device"];
    filter.status = Status::done;
    filter.limit = 1;
    if (filter.device.empty()) {
        const ReportPage newest = service.store.reports().list(filter);
        if (!newest.reports.empty()) filter.device = newest.reports.front().device;
    }
    filter.limit = request.query["limit"];
    return filter;
}

Answer get_trend(Service& service, const Request& request) {
    const ListFilter filter = filter_of_trend(service, request);
    std::vector<TrendReport> reports = service.store.trends().reports(filter);
    for (TrendReport& report : reports) complete(service, report);
    const std::vector<TrendName> names = names_of(reports);
    answer::Trend trend{.spec_sha256 = filter.spec_sha256, .device = filter.device};
    trend.metrics = different(names, &TrendName::metric);
    trend.methods = different(names, &TrendName::method);
    trend.points = different(names, &TrendName::point);
    trend.metric = chosen(request.query["metric"], trend.metrics, "metric");
    trend.method = chosen(request.query["method"], trend.methods, "method");
    trend.point = chosen(request.query["point"], trend.points, "point");
    const Quantity* const quantity = find_quantity(trend.metric);
    if (quantity) trend.unit = quantity->unit;
    std::vector<Measured> series;
    NumberFinder finder({trend.point, trend.method, trend.metric});
    for (const TrendReport& report : reports) {
        const auto number = report.numbers ? finder.find(*report.numbers) : std::nullopt;
        if (!number) {
            ++trend.missing;
            continue;
        }
        trend.values.push_back(
            {.report = report.id, .created_at = utc_text(report.created_ms), .value = number->value});
        if (std::isfinite(number->low)) trend.values.back().low = number->low;
        if (std::isfinite(number->high)) trend.values.back().high = number->high;
        series.push_back(*number);
    }
    for (const ChangePoint& point : change_points(series))
        trend.change_points.push_back({.before = trend.values[point.index - 1].report,
                                       .after = trend.values[point.index].report,
                                       .index = point.index,
                                       .level_before = told_level(point.before),
                                       .level_after = told_level(point.after),
                                       .p = point.p});
    return json_response(200, to_document(trend));
}

}  // namespace

std::vector<Route> trend_routes(Service& service) {
    return {{.method = "GET",
             .pattern = trends_path,
             .id = "getTrend",
             .summary = "A number of the done reports of one spec and device over time, and where its level changed",
             .query = {Param::text("spec_sha256", "SHA-256 of the spec", "", longest_name_bytes).required(),
                       Param::text("metric", "as checks name it; by default the first", "", longest_name_bytes),
                       Param::text("method", "label of the method; by default the first", "", longest_name_bytes),
                       Param::text("point", "point of the sweep, as in `points`; by default the first", "", 4096),
                       Param::text("tag", "name of a tag, or name:value; each that is given", "", longest_name_bytes),
                       Param::text("device", "name of the renderer; by default that of the newest report", "",
                                   longest_name_bytes),
                       Param::integer("limit", "greatest number of reports, the newest", "", most_reports, 1,
                                      most_reports)},
             .replies = {{200, "The values, oldest first; none if there is no such report", "application/json",
                          "SpecTrend"}},
             .handle = [&service](const Request& request) { return get_trend(service, request); },
             .repeatable = {"tag"}}};
}

}  // namespace sheer::http
