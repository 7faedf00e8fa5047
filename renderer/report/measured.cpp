#include "renderer/report/measured.h"

#include <algorithm>
#include <limits>

namespace sheer {

using nlohmann::json;

json measured(const json& result, const std::string& metric) {
    if (metric == "speedup") return result["speedup"].is_null() ? json() : result["speedup"]["value"];
    const bool beside_metrics =
        metric.starts_with("timing.") || metric.starts_with("fragments.") || metric == "memory_bytes";
    json value = beside_metrics ? result : result["metrics"];
    for (std::size_t begin = 0; begin <= metric.size() && !value.is_null();) {
        const std::size_t end = std::min(metric.find('.', begin), metric.size());
        value = value.is_object() ? value.value(metric.substr(begin, end - begin), json()) : json();
        begin = end + 1;
    }
    return value;
}

std::optional<Measured> measured_with_interval(const json& result, const std::string& metric) {
    const json value = measured(result, metric);
    if (!value.is_number()) return std::nullopt;
    if (metric != "speedup" && metric != "timing.median") return Measured{value, value, value};
    const json& interval = result[metric == "speedup" ? "speedup" : "timing"]["ci95"];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!interval.is_array()) return Measured{value, -infinity, infinity};
    return Measured{value, interval[0], interval[1]};
}

const json* find_result(const json& run, const std::string& label) {
    const json& results = run.at("results");
    const auto found = std::ranges::find_if(results, [&](const json& result) { return result["label"] == label; });
    return found == results.end() ? nullptr : &*found;
}

}  // namespace sheer
