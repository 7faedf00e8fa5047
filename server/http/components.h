#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sheer::http {

inline constexpr const char* components_prefix = "#/components/schemas/";

/// The schemas of everything that the service reads and answers as JSON, by their names in the OpenAPI document.
std::map<std::string, nlohmann::json> component_schemas();

}  // namespace sheer::http
