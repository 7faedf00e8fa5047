#pragma once
#include <filesystem>
#include <string>

#include "renderer/assets/file_assets.h"
#include "renderer/command/command.h"

namespace sheer::cli {

/// Adds --context and what add_device_options() adds: --device and --without-workaround to `command`.
void add_context_options(CLI::App& command, gl::ContextRequest& request);

/// Writes a report whole: `fill` gets a temporary folder beside `folder`, which then takes the place of `folder`.
/// Throws UsageError, before anything is done, if `folder` holds something else.
class ReportFolder {
  public:
    /// `main_file` is what such a folder holds in any case, by which it is known.
    explicit ReportFolder(std::filesystem::path folder, const std::string& main_file = "report.json");
    ~ReportFolder();
    ReportFolder(const ReportFolder&) = delete;
    ReportFolder& operator=(const ReportFolder&) = delete;

    const std::filesystem::path& partial() const { return m_partial; }
    /// Throws std::filesystem::filesystem_error.
    void commit();

  private:
    std::filesystem::path m_folder, m_partial;
};

/// Uploaded files by their SHA-256, and nothing else.
FileAssets::Resolver uploads_in(const std::filesystem::path& folder);

}  // namespace sheer::cli
