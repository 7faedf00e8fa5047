#pragma once
#include <cstdint>

#include "renderer/spec/spec.h"

namespace sheer::http {

/// What one comparison may ask for, besides the limits that every spec has. The fields of the configuration describe
/// each (`jobs`).
struct JobLimits {
    std::int64_t max_pixels = 4096 * 4096;  ///< of one picture
    std::int64_t max_methods = 64;
    std::int64_t max_points = 256;  ///< of its sweep
    std::int64_t max_cost = 1'000'000'000;
};

/// A measure of the work of a comparison that is known before it is rendered, in megapixels: at each point of its sweep
/// every method and the reference draw a picture in each round of warming up and timing. How much a scene covers
/// itself is not in it.
double cost_mpx(const Spec& spec);

/// Throws SpecError, with a field for each limit that the spec exceeds.
void require_within(const JobLimits& limits, const Spec& spec);

}  // namespace sheer::http
