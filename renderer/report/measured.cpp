#include "renderer/report/measured.h"

#include <algorithm>
#include <limits>

namespace sheer {

using nlohmann::json;

namespace {

bool is_speedup(const std::string& metric) {
    return metric == "speedup" || metric == "speedup_with_sort";
}

/// Whether it is found beside `metrics` in a result, and not in it.
bool beside_metrics(const std::string& metric) {
    return metric.starts_with("timing.") || metric.starts_with("fragments.") || metric == "memory_bytes" ||
           is_speedup(metric);
}

/// What a report says beside the null of `key`; "" where it says nothing.
std::string reason_beside(const json& owner, const std::string& key) {
    const json reason = owner.value(key + "_reason", json());
    return reason.is_string() ? reason.get<std::string>() : "";
}

}  // namespace

json measured(const json& result, const std::string& metric) {
    if (is_speedup(metric)) {
        const json speedup = result.value(metric, json());
        return speedup.is_null() ? json() : speedup["value"];
    }
    json value = beside_metrics(metric) ? result : result["metrics"];
    for (std::size_t begin = 0; begin <= metric.size() && !value.is_null();) {
        const std::size_t end = std::min(metric.find('.', begin), metric.size());
        value = value.is_object() ? value.value(metric.substr(begin, end - begin), json()) : json();
        begin = end + 1;
    }
    return value;
}

std::string no_measure_reason(const json& result, const std::string& metric) {
    if (result["status"] != "ok") {
        const std::string status = result["status"];
        return result["reason"].is_string() ? status + ": " + result["reason"].get<std::string>() : status;
    }
    const std::string path = beside_metrics(metric) ? metric : "metrics." + metric;
    json owner = result;
    for (std::size_t begin = 0; begin <= path.size() && owner.is_object();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string key = path.substr(begin, end - begin);
        if (std::string reason = reason_beside(owner, key); !reason.empty()) return reason;
        owner = owner.value(key, json());
        begin = end + 1;
    }
    return "it was not measured";
}

std::optional<Measured> measured_with_interval(const json& result, const std::string& metric) {
    const json value = measured(result, metric);
    if (!value.is_number()) return std::nullopt;
    const bool is_median = metric.starts_with("timing.") && metric.ends_with(".median");
    if (!is_speedup(metric) && !is_median) return Measured{value, value, value};
    const json interval =
        is_median ? measured(result, metric.substr(0, metric.rfind('.')) + ".ci95") : result[metric]["ci95"];
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
