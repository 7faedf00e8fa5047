#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/scene/assets.h"

namespace sheer {

/// A kind of file that may be uploaded for specs to refer to.
struct AssetKind {
    std::string media_type;
    std::string type;  ///< texture, model or volume: which fields of a spec may refer to it
    /// Reads the whole file and returns an object with what a user may want to know about it, such as its width.
    /// Throws AssetError if it is not of this kind. A malicious file may crash it, so it runs in a process of its own.
    std::function<nlohmann::json(const std::filesystem::path& file)> check;
    std::vector<std::string> suffixes;  ///< of such files' names: lower case, with the dot
};

const std::vector<AssetKind>& asset_kinds();
/// Null if there is none; `media_type` without parameters, in lower case.
const AssetKind* find_asset_kind(const std::string& media_type);

/// The result of the kind's check. Throws AssetError, also for an unknown media type.
nlohmann::json check_asset(const std::filesystem::path& file, const std::string& media_type);

}  // namespace sheer
