#include "renderer/scene/asset_kinds.h"

#include <algorithm>

namespace sheer {

const std::vector<AssetKind>& asset_kinds() {
    static const std::vector<AssetKind> kinds = {
        {"image/png", "texture", "PNG", {".png"}},
        {"image/jpeg", "texture", "JPEG", {".jpg", ".jpeg"}},
        {"image/x-exr", "texture", "OpenEXR file", {".exr"}},
        {"application/x-nrrd", "volume", "NRRD", {".nrrd"}},
        {"application/octet-stream", "volume", "raw", {".raw"}},
        {"model/gltf-binary", "model", "glb", {".glb"}},
        {"model/gltf+json", "model", "gltf", {".gltf"}},
    };
    return kinds;
}

const AssetKind* find_asset_kind(const std::string& media_type) {
    const auto found = std::ranges::find(asset_kinds(), media_type, &AssetKind::media_type);
    return found == asset_kinds().end() ? nullptr : &*found;
}

}  // namespace sheer
