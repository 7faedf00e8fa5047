#pragma once
#include <filesystem>
#include <string>

#include "server/jobs/store.h"

namespace sheer {

/// The folder of one attempt, FOLDER/<id>-<attempt>, removed with this object.
class ScratchFolder {
  public:
    /// Makes it, and removes those of earlier attempts. Throws std::filesystem::filesystem_error.
    ScratchFolder(const std::filesystem::path& folder, const std::string& id, int attempt);
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder();

    const std::filesystem::path& path() const { return m_path; }

  private:
    std::filesystem::path m_path;
};

/// Removes what killed workers left: the folders of jobs that are not running.
void sweep_scratch(const std::filesystem::path& folder, Store& store);

}  // namespace sheer
