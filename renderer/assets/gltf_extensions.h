#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sheer {

/// Whether the extension is read here.
bool is_extension_read(std::string_view name);

/// Whether the extension only concerns what is not drawn (lights, animation, reflections, metadata), so that a file may
/// require it and still be drawn.
bool is_extension_beside_the_picture(std::string_view name);

/// The extensions of a glTF document that are not read, each with the place of its first use,
/// "materials[2].extensions.KHR_...", or "extensionsUsed" if it is only announced.
std::map<std::string, std::string> unread_extensions(const nlohmann::json& document);

}  // namespace sheer
