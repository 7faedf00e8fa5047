#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/errors.h"

namespace sheer {

inline constexpr std::size_t max_sweeps = 4, max_sweep_points = 256;

/// A point of a sweep: the values by their JSON pointers, {"/scene/count": 16}; {} where nothing is swept.
using SweepPoint = nlohmann::json;

/// Reads the `sweep` of a spec, an array of axes. An axis is {"pointer", "values"}, or {"points"}: an array of objects
/// that set several fields at once. Returns the Cartesian product of the axes, the last one changing fastest; a single
/// {} without axes. `document` is the normalised spec, whose fields the pointers must meet.
/// Adds an error for whatever is wrong and returns what is right.
std::vector<SweepPoint> read_sweep(const nlohmann::json& sweep, const nlohmann::json& document,
                                   std::vector<FieldError>& errors);

/// "count 16, size 64"; "" for {}.
std::string describe_point(const SweepPoint& point);

/// The axis of each value of a point, as a pointer such as "/sweep/0", for errors.
std::string sweep_pointer(const nlohmann::json& sweep, const std::string& field_pointer);

/// Whether the point has all the values of `at`.
bool lies_at(const SweepPoint& point, const nlohmann::json& at);

/// The spec with a point's values in place, without `sweep` and `checks`.
nlohmann::json at_point(nlohmann::json document, const SweepPoint& point);

}  // namespace sheer
