#include "server/cli/rendering/rendering.h"

#include <fmt/format.h>

#include "renderer/core/sha256.h"
#include "server/jobs/limits.h"
#include "server/storage/content_folder.h"
#include "server/storage/data_folder.h"

namespace sheer::cli {

void add_context_options(CLI::App& command, gl::ContextRequest& request) {
    command.add_option("--context", request.context, "How to make a context: auto tries EGL, then OSMesa")
        ->check(CLI::IsMember({"auto", "egl", "osmesa", "glfw"}))
        ->capture_default_str();
    add_device_options(command, request);
}

FileAssets::Resolver uploads_of(const std::string& data) {
    return [data](const std::string& name) {
        if (data.empty() || !is_sha256(name)) throw AssetError("this is not the SHA-256 of an uploaded file");
        const ContentFolder uploads(DataFolder{data}.assets());
        const auto file = uploads.find(name);
        if (!file) throw AssetError("the asset with this SHA-256 no longer exists");
        try {
            uploads.open(name);
        } catch (const DamagedData& damaged) {
            throw AssetError(fmt::format("the asset with this SHA-256 is damaged: {}", damaged.what()));
        }
        return *file;
    };
}

report::PictureReader stored_pictures(const std::string& data) {
    return [blobs = std::make_shared<ContentFolder>(DataFolder{data}.blobs())](const report::Picture& picture) {
        return read_all(*blobs->open(picture.sha256), max_picture_bytes);
    };
}

}  // namespace sheer::cli
