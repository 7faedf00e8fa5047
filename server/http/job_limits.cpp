#include "server/http/job_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "renderer/spec/spec.h"

namespace sheer::http {

namespace {

/// At each point: a sweep may be over the size of the picture. Making the specs of all points would take seconds.
std::vector<double> pixels_at_points(const Spec& spec) {
    std::vector<double> pixels;
    for (const SweepPoint& point : spec.points)
        pixels.push_back(point.value("/image/width", double(spec.image.width_px)) *
                         point.value("/image/height", double(spec.image.height_px)));
    return pixels;
}

}  // namespace

double cost_mpx(const Spec& spec) {
    const auto pixels = pixels_at_points(spec);
    const double frames = static_cast<double>(spec.methods.size() + 1) * (spec.timing.warmup + spec.timing.rounds);
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) * frames / 1e6;
}

void require_within(const JobLimits& limits, const Spec& spec) {
    std::vector<FieldError> errors;
    const auto require = [&errors](const char* pointer, double value, std::int64_t limit, const char* unit) {
        if (value > static_cast<double>(limit))
            errors.push_back(
                {pointer, fmt::format("asks for {:.0f} {}; this service takes at most {}", value, unit, limit)});
    };
    require("/image", std::ranges::max(pixels_at_points(spec)), limits.max_pixels, "pixels");
    require("/methods", static_cast<double>(spec.methods.size()), limits.max_methods, "methods");
    require("/sweep", static_cast<double>(spec.points.size()), limits.max_points, "points");
    require("", cost_mpx(spec), limits.max_cost, "megapixels (width x height x rounds x methods x points)");
    if (!errors.empty()) throw SpecError(std::move(errors));
}

}  // namespace sheer::http
