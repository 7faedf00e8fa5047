#include "server/cli/rendering.h"

#include "server/archive/blob_store.h"
#include "server/cli/commands.h"

namespace sheer::cli {

void add_context_options(CLI::App& command, gl::ContextRequest& request) {
    command.add_option("--context", request.context, "Where to render: auto tries EGL, then OSMesa")
        ->check(CLI::IsMember({"auto", "egl", "osmesa", "glfw"}))
        ->capture_default_str();
    add_device_options(command, request);
}

FileAssets::Resolver uploads_in(const std::filesystem::path& folder) {
    return [folder](const std::string& name) {
        if (folder.empty() || !is_sha256(name)) throw AssetError("this is not the SHA-256 of an uploaded file");
        std::filesystem::path file = blob_path(folder, name);
        if (!std::filesystem::exists(file)) throw AssetError("the asset with this SHA-256 is not there any more");
        try {
            if (sha256_of_file(file) == name) return file;
        } catch (const StoreError&) {
            throw AssetError("the asset with this SHA-256 cannot be read");
        }
        throw AssetError("the asset with this SHA-256 is damaged: its bytes have another hash");
    };
}

}  // namespace sheer::cli
