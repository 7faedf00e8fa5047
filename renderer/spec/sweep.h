#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/core/errors.h"

namespace sheer {

inline constexpr std::size_t max_sweeps = 4, max_sweep_points = 256;
/// Limit for what a sweep repeats at its points (see json_weight): some seconds of checking.
inline constexpr std::size_t max_sweep_weight = 8'000'000;

/// The device's label in the points of a report of several devices.
inline constexpr const char* device_pointer = "/device";

/// A point of a sweep: values by JSON pointer, {"/scene/count": 16}; {} without a sweep.
using SweepPoint = nlohmann::json;

/// Reads the `sweep` of a spec, an array of axes. An axis is {"pointer", "values"}, or {"points"}: an array of objects
/// that set several fields at once. No axis may set a part of a field that another one sets. Returns the Cartesian
/// product of the axes, the last one changing fastest; a single {} without axes. `document` is the normalised spec,
/// whose fields the pointers must match. Adds an error for each mistake and returns the valid points.
std::vector<SweepPoint> read_sweep(const nlohmann::json& sweep, const nlohmann::json& document,
                                   std::vector<FieldError>& errors);

/// The work of checking a value: the number of values in it, plus one for every 32 bytes of text.
std::size_t json_weight(const nlohmann::json& value);

/// "count 16, size 64"; "" for {}.
std::string describe_point(const SweepPoint& point);

/// The axis of each value of a point as a pointer, such as "/sweep/0", for errors.
std::string sweep_pointer(const nlohmann::json& sweep, const std::string& field_pointer);

/// Whether the point has all the values of `at`.
bool lies_at(const SweepPoint& point, const nlohmann::json& at);

/// The spec with a point's values set, without `sweep` and `checks`.
nlohmann::json at_point(nlohmann::json document, const SweepPoint& point);

}  // namespace sheer
