#include "server/http/job_limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer::http {

namespace {

std::int64_t pixels_of(const Spec& spec) {
    return std::int64_t{spec.image.width_px} * spec.image.height_px;
}

/// `value` of the spec at each of its points: a sweep may be over the size of the picture or the number of rounds.
template <typename Value>
std::vector<double> at_points(const Spec& spec, const Value& value) {
    const auto changes_it = [](const SweepPoint& point) {
        return std::ranges::any_of(point.items(), [](const auto& item) {
            return item.key().starts_with("/image") || item.key().starts_with("/timing");
        });
    };
    std::vector<double> values;
    for (const SweepPoint& point : spec.points)
        values.push_back(static_cast<double>(changes_it(point) ? value(spec_at(spec, point)) : value(spec)));
    return values;
}

}  // namespace

double cost_mpx(const Spec& spec) {
    double cost = 0;
    for (const double frames_px :
         at_points(spec, [](const Spec& at) { return pixels_of(at) * (at.timing.warmup + at.timing.rounds); }))
        cost += frames_px * static_cast<double>(spec.methods.size() + 1) / 1e6;
    return cost;
}

void require_within(const JobLimits& limits, const Spec& spec) {
    std::vector<FieldError> errors;
    const auto require = [&errors](const char* pointer, double value, std::int64_t limit, const char* unit) {
        if (value > static_cast<double>(limit))
            errors.push_back(
                {pointer, fmt::format("asks for {:.0f} {}; this service takes at most {}", value, unit, limit)});
    };
    require("/image", std::ranges::max(at_points(spec, pixels_of)), limits.max_pixels, "pixels");
    require("/methods", static_cast<double>(spec.methods.size()), limits.max_methods, "methods");
    require("/sweep", static_cast<double>(spec.points.size()), limits.max_points, "points");
    require("", cost_mpx(spec), limits.max_cost, "megapixels (width x height x rounds x methods x points)");
    if (!errors.empty()) throw SpecError(std::move(errors));
}

}  // namespace sheer::http
