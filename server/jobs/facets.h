#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sheer {

/// The properties by which the archive can be searched.
struct Facets {
    std::string title;
    std::string scene;                               ///< type
    std::vector<std::string> methods;                ///< ids, in the order of the spec, each once
    nlohmann::json tags = nlohmann::json::object();  ///< texts by name
};

/// From the normalised spec of a report.
Facets facets_of(const nlohmann::json& spec);

/// The labels of the workers that a spec asks for; none for any worker.
std::vector<std::string> wanted_devices(const nlohmann::json& spec);
/// The same if the spec lists devices, each of which renders a part of the report; otherwise none.
std::vector<std::string> listed_devices(const nlohmann::json& spec);

/// The preview picture of a done report: the reference of its first point, or its first method's picture; null if it
/// has none.
nlohmann::json preview_of(const nlohmann::json& report);

/// The name of the device in a done report; "" if it has none.
std::string renderer_of(const nlohmann::json& report);

}  // namespace sheer
