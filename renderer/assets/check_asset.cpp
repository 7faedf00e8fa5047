#include "renderer/assets/check_asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_file.h"
#include "renderer/assets/read_model.h"
#include "renderer/assets/read_volume.h"

namespace sheer {

using nlohmann::json;

namespace {

AssetKind picture_kind(const char* media_type, PictureFormat format, std::vector<std::string> suffixes) {
    const auto check = [format](const std::filesystem::path& file) {
        const std::string bytes = read_asset_bytes(file);
        if (const PictureHeader header = read_picture_header(bytes); header.format != format)
            throw AssetError(fmt::format("the file is a {}, not a {}", name_of(header.format), name_of(format)));
        const PictureFacts facts = decode_picture(bytes, [](int, const float*) {});
        return json{{"width", facts.header.width_px},
                    {"height", facts.header.height_px},
                    {"channels", facts.channels},
                    {"notes", to_json(facts.notes)}};
    };
    return {media_type, "texture", check, std::move(suffixes)};
}

AssetKind nrrd_kind() {
    return {"application/x-nrrd",
            "volume",
            [](const std::filesystem::path& file) { return describe_nrrd(read_asset_bytes(file)); },
            {".nrrd"}};
}

/// The spec describes their contents, so there is nothing to check yet.
AssetKind raw_volume_kind() {
    return {"application/octet-stream",
            "volume",
            [](const std::filesystem::path& file) {
                return json{{"bytes", read_asset_bytes(file).size()}};
            },
            {".raw"}};
}

AssetKind model_kind(const char* media_type, bool binary, std::vector<std::string> suffixes) {
    const auto check = [binary](const std::filesystem::path& file) {
        const std::string bytes = read_asset_bytes(file);
        if (bytes.starts_with("glTF") != binary)
            throw AssetError(binary ? "the file is not a .glb, which begins with \"glTF\""
                                    : "the file is a .glb, not a .gltf");
        const Model model = read_model(bytes, no_other_files);
        std::size_t triangles = 0;
        for (const ModelPart& part : model.parts) triangles += part.indices.size() / 3;
        return json{{"triangles", triangles},
                    {"materials", model.materials.size()},
                    {"pictures", model.pictures.size()},
                    {"notes", to_json(model.notes)}};
    };
    return {media_type, "model", check, std::move(suffixes)};
}

}  // namespace

const std::vector<AssetKind>& asset_kinds() {
    static const std::vector<AssetKind> kinds = {
        picture_kind("image/png", PictureFormat::png, {".png"}),
        picture_kind("image/jpeg", PictureFormat::jpeg, {".jpg", ".jpeg"}),
        picture_kind("image/x-exr", PictureFormat::exr, {".exr"}),
        nrrd_kind(),
        raw_volume_kind(),
        model_kind("model/gltf-binary", true, {".glb"}),
        model_kind("model/gltf+json", false, {".gltf"}),
    };
    return kinds;
}

const AssetKind* find_asset_kind(const std::string& media_type) {
    const auto found = std::ranges::find(asset_kinds(), media_type, &AssetKind::media_type);
    return found == asset_kinds().end() ? nullptr : &*found;
}

json check_asset(const std::filesystem::path& file, const std::string& media_type) {
    const AssetKind* kind = find_asset_kind(media_type);
    if (kind == nullptr) throw AssetError("files of the type " + media_type + " are not accepted");
    return kind->check(file);
}

}  // namespace sheer
