// What there is to choose from, as `GET /methods` and its like tell it.
#include "renderer/methods/method.h"
#include "renderer/metrics/metric.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/param.h"
#include "renderer/spec/spec.h"

namespace sheer {

using nlohmann::json;

json describe_methods() {
    json all = json::array();
    for (const MethodInfo& method : all_methods()) {
        all.push_back(
            {{"id", method.id},
             {"name", method.name},
             {"kind", method.kind},
             {"summary", method.summary},
             {"paper", method.paper},
             {"good_at", method.good_at},
             {"bad_at", method.bad_at},
             {"memory", method.memory},
             {"needs_sorting", method.needs_sorting},
             {"parameters", to_json(method.parameters)},
             {"no_metrics_reason", method.no_metrics_reason.empty() ? json() : json(method.no_metrics_reason)}});
    }
    return all;
}

json describe_scenes() {
    json all = json::array();
    for (const SceneInfo& scene : all_scenes()) {
        all.push_back({{"id", scene.id},
                       {"name", scene.name},
                       {"summary", scene.summary},
                       {"source", scene.source},
                       {"parameters", to_json(scene.all_parameters())}});
    }
    return all;
}

json describe_metrics() {
    json all = json::array();
    for (const MetricInfo& metric : all_metrics()) {
        json fields = json::array();
        for (const MetricField& field : metric.fields)
            fields.push_back(
                {{"name", field.name}, {"unit", field.unit}, {"range", field.range}, {"summary", field.summary}});
        all.push_back({{"id", metric.id},
                       {"name", metric.name},
                       {"summary", metric.summary},
                       {"source", metric.source},
                       {"picture", metric.picture},
                       {"fields", fields}});
    }
    return all;
}

}  // namespace sheer
