#pragma once
#include <filesystem>
#include <string>

#include "server/jobs/report_archive.h"

namespace sheer {

/// The folder of one attempt, removed with this object: FOLDER/<id>-<attempt>, with .1, .2, ... appended if something
/// of that name cannot be removed. For later parts of a report of several devices it is FOLDER/<id>-p<part>.<attempt>,
/// since the worker of the part before may still be removing its own.
class ScratchFolder {
  public:
    /// Makes it, and removes those of earlier attempts if possible. Throws std::filesystem::filesystem_error.
    ScratchFolder(const std::filesystem::path& folder, const std::string& id, int attempt, int parts_ended = 0);
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder();

    const std::filesystem::path& path() const { return m_path; }

  private:
    std::filesystem::path m_path;
};

/// Copies the files of a driver's folder of compiled shaders, as far as they fit in 64 MiB. What cannot be copied,
/// since another renderer has just removed it, is left out.
void copy_shaders(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes the leftovers of killed workers: the folders of jobs that are not running.
void sweep_scratch(const std::filesystem::path& folder, ReportArchive& reports);

}  // namespace sheer
