#pragma once
#include <filesystem>
#include <string>

#include "renderer/assets/file_assets.h"
#include "renderer/command/command.h"
#include "renderer/results/report.h"

namespace sheer::cli {

/// Adds --context and the options of add_device_options(), --device and --without-workaround, to `command`.
void add_context_options(CLI::App& command, gl::ContextRequest& request);

/// The uploaded files of a service by their SHA-256, and nothing else. `data` is its folder, "" for none.
FileAssets::Resolver uploads_of(const std::string& data);

/// Reads pictures of a service's reports; it throws DamagedData. `data` is the service's folder.
report::PictureReader stored_pictures(const std::string& data);

}  // namespace sheer::cli
