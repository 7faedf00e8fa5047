#pragma once
#include <nlohmann/json_fwd.hpp>

namespace sheer {

/// Whether the normalised spec has programs or files of others: GLSL, or the SHA-256 of an upload. Otherwise it has
/// only numbers and names that are ours, so its renderer runs nothing that could leave something behind for the next
/// job.
bool has_foreign_input(const nlohmann::json& spec);

}  // namespace sheer
