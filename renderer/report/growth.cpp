#include "renderer/report/growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace sheer {

namespace {

using report::Growth;
using Points = std::vector<std::pair<double, double>>;

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// The values of one method along an axis, at each combination of the other fields' values.
struct Series {
    report::Point at;
    std::string method;
    Points points;
};

void add_to(std::vector<Series>& all, const report::Point& at, const std::string& method,
            const std::pair<double, double>& point) {
    auto series = std::ranges::find_if(all, [&](const Series& one) { return one.at == at && one.method == method; });
    if (series == all.end()) series = all.insert(all.end(), {at, method, {}});
    series->points.push_back(point);
}

bool all_numbers(const nlohmann::json& values) {
    return std::ranges::all_of(values, [](const nlohmann::json& value) { return value.is_number(); });
}

/// The fields that the axis sets; none if it sets one to anything but numbers.
std::vector<std::string> number_fields_of(const nlohmann::json& axis) {
    std::set<std::string> fields;
    const nlohmann::json points = axis.value("points", nlohmann::json::array());
    for (const auto& point : points)
        for (const auto& [pointer, value] : point.items()) {
            if (!value.is_number()) return {};
            fields.insert(pointer);
        }
    if (points.empty() && all_numbers(axis.at("values"))) fields.insert(axis.at("pointer").get<std::string>());
    return {fields.begin(), fields.end()};
}

constexpr const char* measured_metrics[] = {"timing.median", "memory_bytes"};

std::optional<double> value_of(const std::string& metric, const report::Result& result) {
    if (metric == "timing.median") return result.timing ? std::optional(result.timing->median) : std::nullopt;
    return result.memory_bytes ? std::optional(static_cast<double>(*result.memory_bytes)) : std::nullopt;
}

std::vector<Series> series_along(const std::vector<std::string>& fields, const std::string& metric,
                                 const std::vector<report::Run>& runs) {
    std::vector<Series> all;
    for (const report::Run& run : runs) {
        if (!run.point.contains(fields.front())) continue;
        report::Point at = run.point;
        for (const std::string& field : fields) at.erase(field);
        for (const report::Result& result : run.results)
            if (const auto value = value_of(metric, result))
                add_to(all, at, result.label, {run.point[fields.front()], *value});
    }
    return all;
}

}  // namespace

double student_t95(std::size_t degrees) {
    static constexpr std::array small = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060,
                                         2.2622,  2.2281, 2.2010, 2.1788, 2.1604, 2.1448, 2.1314, 2.1199,
                                         2.1098,  2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687, 2.0639,
                                         2.0595,  2.0555, 2.0518, 2.0484, 2.0452, 2.0423};
    if (degrees <= small.size()) return small[degrees - 1];
    // Cornish-Fisher expansion about the normal quantile.
    constexpr double z = 1.959964;
    const auto n = static_cast<double>(degrees);
    return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

std::optional<PowerLaw> fit_power_law(const Points& points) {
    if (points.size() < 3) return std::nullopt;
    std::vector<double> x, y;
    for (const auto& [one_x, one_y] : points) {
        if (!(one_x > 0) || !(one_y > 0)) return std::nullopt;
        x.push_back(std::log(one_x));
        y.push_back(std::log(one_y));
    }
    const double mean_x = mean(x), mean_y = mean(y);
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (xx == 0) return std::nullopt;
    const double slope = xy / xx;
    double squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) squares += std::pow(y[i] - mean_y - slope * (x[i] - mean_x), 2);
    const std::size_t degrees = x.size() - 2;
    const double half = student_t95(degrees) * std::sqrt(squares / static_cast<double>(degrees) / xx);
    return PowerLaw{slope, {slope - half, slope + half}};
}

std::vector<Growth> growth_of(const nlohmann::json& sweep, const std::vector<report::Run>& runs) {
    std::vector<Growth> all;
    for (const nlohmann::json& axis : sweep) {
        const std::vector<std::string> fields = number_fields_of(axis);
        if (fields.empty()) continue;
        for (const char* metric : measured_metrics)
            for (const Series& series : series_along(fields, metric, runs))
                if (const auto law = fit_power_law(series.points))
                    all.push_back({metric, fields.front(), series.at, series.method, law->exponent,
                                   report::Interval{law->ci95.first, law->ci95.second}, series.points.size()});
    }
    return all;
}

}  // namespace sheer
