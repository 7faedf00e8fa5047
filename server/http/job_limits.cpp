#include "server/http/job_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace sheer::http {

namespace {

std::int64_t pixels_of(const Spec& spec) {
    return std::int64_t{spec.image.width_px} * spec.image.height_px;
}

/// At each point: a sweep may be over the size of the picture.
std::vector<double> pixels_at_points(const Spec& spec) {
    std::vector<double> pixels;
    for (const SweepPoint& point : spec.points) {
        bool is_of_image = false;
        for (const auto& [pointer, value] : point.items()) is_of_image |= pointer.starts_with("/image");
        pixels.push_back(static_cast<double>(pixels_of(is_of_image ? spec_at(spec, point) : spec)));
    }
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
