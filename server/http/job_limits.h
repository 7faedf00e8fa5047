#pragma once
#include "server/http/limits.h"

namespace sheer {
struct Spec;
}

namespace sheer::http {

/// A measure of the work of a comparison that is known before it is rendered, in megapixels: at each point of its sweep
/// every method and the reference draw a picture in each round of warming up and timing. How much a scene covers
/// itself is not in it.
double cost_mpx(const Spec& spec);

/// Throws SpecError, with a field for each limit that the spec exceeds.
void require_within(const JobLimits& limits, const Spec& spec);

}  // namespace sheer::http
