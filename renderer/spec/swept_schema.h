#pragma once
#include <nlohmann/json_fwd.hpp>

namespace sheer {

/// The schema of a point of a sweep: values by JSON pointer into the spec, each as described for its field.
nlohmann::json swept_point_schema();
/// The schema of an axis of a sweep.
nlohmann::json swept_axis_schema();

}  // namespace sheer
