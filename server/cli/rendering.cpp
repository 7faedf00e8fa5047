#include "server/cli/rendering.h"

#include <fmt/format.h>
#include <unistd.h>

#include "server/archive/blob_store.h"
#include "server/cli/commands.h"

namespace sheer::cli {

void add_context_options(CLI::App& command, gl::ContextRequest& request) {
    command.add_option("--context", request.context, "Where to render: auto tries EGL, then OSMesa")
        ->check(CLI::IsMember({"auto", "egl", "osmesa", "glfw"}))
        ->capture_default_str();
    add_device_options(command, request);
}

ReportFolder::ReportFolder(std::filesystem::path folder, const std::string& main_file) : m_folder(std::move(folder)) {
    if (!m_folder.has_filename()) m_folder = m_folder.parent_path();
    const bool exists = std::filesystem::exists(m_folder);
    if (exists && !std::filesystem::is_directory(m_folder)) throw UsageError(m_folder.string() + " is not a folder");
    if (exists && !std::filesystem::is_empty(m_folder) && !std::filesystem::exists(m_folder / main_file))
        throw UsageError(fmt::format("{} holds files but no {}; choose another folder", m_folder.string(), main_file));
    m_partial = m_folder;
    m_partial += fmt::format(".partial-{}", getpid());
    std::filesystem::create_directories(m_partial);
}

ReportFolder::~ReportFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_partial, ignored);
}

void ReportFolder::commit() {
    std::filesystem::remove_all(m_folder);
    std::filesystem::rename(m_partial, m_folder);
}

FileAssets::Resolver uploads_in(const std::filesystem::path& folder) {
    return [folder](const std::string& name) {
        if (folder.empty() || !is_sha256(name)) throw AssetError("this is not the SHA-256 of an uploaded file");
        std::filesystem::path file = blob_path(folder, name);
        if (!std::filesystem::exists(file)) throw AssetError("the asset with this SHA-256 is not there any more");
        return file;
    };
}

}  // namespace sheer::cli
