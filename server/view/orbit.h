#pragma once
#include <nlohmann/json_fwd.hpp>

namespace sheer::view {

/// `camera`, a field of a spec, moved around its target: by `turn_rad` about its up axis, counterclockwise seen from
/// above, and by `rise_rad` upwards, but never past the top or the bottom.
nlohmann::json orbited(const nlohmann::json& camera, double turn_rad, double rise_rad);

/// `camera` at `factor` times the distance of its target.
nlohmann::json moved_away(const nlohmann::json& camera, double factor);

}  // namespace sheer::view
