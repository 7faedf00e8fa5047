#pragma once
#include <filesystem>
#include <string>

#include "renderer/assets/file_assets.h"
#include "renderer/command/command.h"

namespace sheer::cli {

/// Adds --context and what add_device_options() adds: --device and --without-workaround to `command`.
void add_context_options(CLI::App& command, gl::ContextRequest& request);

/// Uploaded files by their SHA-256, and nothing else.
FileAssets::Resolver uploads_in(const std::filesystem::path& folder);

}  // namespace sheer::cli
