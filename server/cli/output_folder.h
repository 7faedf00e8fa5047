#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "server/cli/manifest.h"

namespace sheer::cli {

/// What is going to be written into a folder.
struct OutputNames {
    std::string main_file;                   ///< what the folder is about; it comes last
    std::vector<std::string> others;         ///< further files beside it
    std::vector<std::string> picture_stems;  ///< pictures in images/ are called STEM.something
};

/// A folder that a report is written into, whole or not at all: it is made in a hidden folder within, and its files
/// take their places when all of them are there. What Sheer did not write, or what was changed since it did, is never
/// removed or overwritten; a Manifest tells the two apart.
class OutputFolder {
  public:
    /// Makes `folder` and those above it if need be. Throws UsageError if it cannot be written, if it holds a file of
    /// the user's where one of `names` goes or a report of another kind, or if another process writes into it just now;
    /// then nothing was touched.
    OutputFolder(std::filesystem::path folder, OutputNames names);
    ~OutputFolder() { discard(); }
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Where to write everything.
    std::filesystem::path partial() const;

    /// Puts what is in partial() into its place, and removes what is left of the report that was there. One that is not
    /// `complete` does not take the place of one that is, but goes into the folder "incomplete" beside it. Returns the
    /// folder that it is in now. Throws UsageError for a file of the user's that is in the way, std::exception if
    /// something cannot be moved; the folder then is as it was.
    std::filesystem::path commit(bool complete = true);

    /// Removes what is in partial(). Called again it does nothing.
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
    std::vector<std::filesystem::path> m_made;  ///< folders that were not there before, the outermost first
    int m_lock = -1;                            ///< locked while this process works in m_work
};

}  // namespace sheer::cli
