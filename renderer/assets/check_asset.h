#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/scene/assets.h"

namespace sheer {

/// Reads the whole file, which should be of this kind (renderer/scene/asset_kinds.h), and returns an object with what a
/// user may want to know about it, such as its width. Throws AssetError if it is of another kind or cannot be read,
/// also for an unknown media type. A malicious file may crash it, so it runs in a process of its own.
nlohmann::json check_asset(const std::filesystem::path& file, const std::string& media_type);

}  // namespace sheer
