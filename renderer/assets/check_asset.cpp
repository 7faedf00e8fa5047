#include "renderer/assets/check_asset.h"

#include <fmt/format.h>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_file.h"
#include "renderer/assets/read_model.h"
#include "renderer/assets/read_volume.h"
#include "renderer/scene/asset_kinds.h"

namespace sheer {

using nlohmann::json;

namespace {

json describe_texture(const std::string& bytes, const std::string& format) {
    if (const std::string found = name_of(read_picture_header(bytes).format); found != format)
        throw AssetError(fmt::format("the file is a {}, not a {}", found, format));
    const PictureFacts facts = decode_picture(bytes, [](int, const float*) {});
    return {{"width", facts.header.width_px},
            {"height", facts.header.height_px},
            {"channels", facts.channels},
            {"notes", to_json(facts.notes)}};
}

/// The spec describes the contents of a raw volume, so there is nothing to check yet.
json describe_volume(const std::string& bytes, const std::string& format) {
    return format == "NRRD" ? describe_nrrd(bytes) : json{{"bytes", bytes.size()}};
}

json describe_model(const std::string& bytes, const std::string& format) {
    const bool binary = format == "glb";
    if (bytes.starts_with("glTF") != binary)
        throw AssetError(binary ? "the file is not a .glb, which begins with \"glTF\""
                                : "the file is a .glb, not a .gltf");
    const Model model = read_model(bytes, no_other_files);
    std::size_t triangles = 0;
    for (const ModelPart& part : model.parts) triangles += part.indices.size() / 3;
    return {{"triangles", triangles},
            {"materials", model.materials.size()},
            {"pictures", model.pictures.size()},
            {"notes", to_json(model.notes)}};
}

}  // namespace

json check_asset(const std::filesystem::path& file, const std::string& media_type) {
    const AssetKind* kind = find_asset_kind(media_type);
    if (kind == nullptr) throw AssetError("files of the type " + media_type + " are not accepted");
    const std::string bytes = read_asset_bytes(file);
    if (kind->type == "texture") return describe_texture(bytes, kind->format);
    if (kind->type == "volume") return describe_volume(bytes, kind->format);
    return describe_model(bytes, kind->format);
}

}  // namespace sheer
