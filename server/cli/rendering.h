#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "renderer/assets/file_assets.h"
#include "renderer/gl/context.h"
#include "renderer/spec/spec.h"

namespace sheer::cli {

/// Adds --context, --device and --without-workaround to `command`.
void add_context_options(CLI::App& command, gl::ContextRequest& request);

/// Throws SpecError, also for a file that cannot be read, naming it.
Spec load_spec(const std::string& path);

/// What was asked for cannot be done as asked. Exit code 2.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Runs `action` and turns what it throws into a message on stderr and an exit code.
int guarded(const std::function<int()>& action);

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

/// Throws std::runtime_error naming the file.
void write_text(const std::filesystem::path& path, const std::string& text);
/// Throws std::runtime_error naming the file.
std::string read_text(const std::filesystem::path& path);

}  // namespace sheer::cli
