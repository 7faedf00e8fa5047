#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/scene/assets.h"

namespace sheer {

/// A kind of file that may be uploaded for specs to refer to.
struct AssetKind {
    std::string media_type;
    std::string type;  ///< texture, model or volume: what fields of a spec may refer to it
    /// Reads the whole file and returns an object of what a user may want to know of it, such as its width.
    /// Throws AssetError if it is not what it is said to be. May die on a file that is made to do harm, so it runs in a
    /// process of its own.
    std::function<nlohmann::json(const std::filesystem::path& file)> check;
    std::vector<std::string> suffixes;  ///< that names of such files end with: lower case, with the dot
};

const std::vector<AssetKind>& asset_kinds();
/// Null if there is none; `media_type` without parameters, in lower case.
const AssetKind* find_asset_kind(const std::string& media_type);

/// What the kind's check says. Throws AssetError, also for a media type that there is not.
nlohmann::json check_asset(const std::filesystem::path& file, const std::string& media_type);

}  // namespace sheer
