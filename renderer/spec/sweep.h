#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/errors.h"

namespace sheer {

inline constexpr std::size_t max_sweeps = 4, max_sweep_points = 256;
/// Of what a sweep repeats at its points (see json_weight): some seconds of checking.
inline constexpr std::size_t max_sweep_weight = 8'000'000;

/// A point of a sweep: the values by their JSON pointers, {"/scene/count": 16}; {} where nothing is swept.
using SweepPoint = nlohmann::json;

/// Reads the `sweep` of a spec, an array of axes. An axis is {"pointer", "values"}, or {"points"}: an array of objects
/// that set several fields at once. No axis may reach into a field that another one sets. Returns the Cartesian product
/// of the axes, the last one changing fastest; a single
/// {} without axes. `document` is the normalised spec, whose fields the pointers must meet.
/// Adds an error for whatever is wrong and returns what is right.
std::vector<SweepPoint> read_sweep(const nlohmann::json& sweep, const nlohmann::json& document,
                                   std::vector<FieldError>& errors);

/// How much work it is to look at a value: the values in it, and 32 bytes of a text count as one more.
std::size_t json_weight(const nlohmann::json& value);

/// "count 16, size 64"; "" for {}.
std::string describe_point(const SweepPoint& point);

/// The axis of each value of a point, as a pointer such as "/sweep/0", for errors.
std::string sweep_pointer(const nlohmann::json& sweep, const std::string& field_pointer);

/// Whether the point has all the values of `at`.
bool lies_at(const SweepPoint& point, const nlohmann::json& at);

/// The spec with a point's values in place, without `sweep` and `checks`.
nlohmann::json at_point(nlohmann::json document, const SweepPoint& point);

}  // namespace sheer
