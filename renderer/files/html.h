#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// One HTML file that needs nothing else; `read_picture` gives the bytes of a picture by its image object.
std::string report_html(const nlohmann::json& report,
                        const std::function<std::string(const nlohmann::json& image)>& read_picture);

}  // namespace sheer
