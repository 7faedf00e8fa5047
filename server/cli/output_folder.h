#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "server/cli/manifest.h"

namespace sheer::cli {

/// The files that will be written into a folder.
struct OutputNames {
    std::string main_file;                   ///< the folder's main file; it comes last
    std::vector<std::string> others;         ///< further files beside it
    std::vector<std::string> picture_stems;  ///< pictures in images/ are called STEM.something
};

/// A folder into which a report is written, completely or not at all: it is made in a hidden folder within, and its
/// files are moved into place when all of them are there. Files that Sheer did not write, or that were changed since,
/// are never removed or overwritten; a Manifest identifies them.
class OutputFolder {
  public:
    /// Makes `folder` and its parents if necessary. Throws UsageError, without changing anything, if it cannot be
    /// written, if it contains a user's file with one of `names` or output of another kind, or if another process is
    /// writing into it.
    OutputFolder(std::filesystem::path folder, OutputNames names);
    ~OutputFolder() { discard(); }
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// The folder to write everything into.
    std::filesystem::path partial() const;

    /// Moves the contents of partial() into place, and removes the rest of the previous report. An incomplete report
    /// does not replace a complete one, but goes into the folder "incomplete" beside it. Returns the folder of the
    /// report. Throws UsageError if a user's file is in the way, and std::exception if something cannot be moved; then
    /// the folder is unchanged.
    std::filesystem::path commit(bool complete = true);

    /// Removes the contents of partial(). Calling it again does nothing.
    void discard() noexcept;

  private:
    void check_names(const std::filesystem::path& folder, const Manifest& manifest) const;
    void make_folder();
    void lock_partial();
    void clear(const std::filesystem::path& folder) const;
    void publish(const std::filesystem::path& folder, bool complete);

    std::filesystem::path m_folder, m_work;
    OutputNames m_names;
    Manifest m_manifest;
    std::vector<std::filesystem::path> m_made;  ///< folders that did not exist before, the outermost first
    int m_lock = -1;                            ///< locked while this process works in m_work
};

}  // namespace sheer::cli
