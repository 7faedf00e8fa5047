#pragma once
#include <string>
#include <vector>

namespace sheer {

/// A kind of file that may be uploaded for specs to refer to.
struct AssetKind {
    std::string media_type;
    std::string type;                   ///< texture, model or volume: which fields of a spec may refer to it
    std::string format;                 ///< what people call it
    std::vector<std::string> suffixes;  ///< of such files' names: lower case, with the dot
};

const std::vector<AssetKind>& asset_kinds();
/// Null if there is none; `media_type` without parameters, in lower case.
const AssetKind* find_asset_kind(const std::string& media_type);

}  // namespace sheer
