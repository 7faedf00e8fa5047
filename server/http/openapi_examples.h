#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace sheer::http {

/// An example of each body that the service reads or writes, by the name of its component; further ones have names of
/// their own. Those of bodies that are not JSON are texts.
std::map<std::string, nlohmann::json> openapi_examples();

/// The headers of answers that the OpenAPI document describes, by name.
const std::map<std::string, std::string>& described_headers();

}  // namespace sheer::http
