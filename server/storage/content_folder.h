#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/content.h"

namespace sheer {

/// Files named by the SHA-256 of their bytes: FOLDER/ab/ab12... A file is complete and on the disk, or does not exist.
class ContentFolder {
  public:
    explicit ContentFolder(std::filesystem::path folder) : m_folder(std::move(folder)) {}

    /// Makes the folder if necessary. Throws StoreError.
    void make() const;
    /// Stores `bytes`, replacing a damaged file; does nothing if they are already stored. Returns whether it wrote
    /// them. Throws StoreFull, and StoreError, also if `sha256` is not theirs.
    bool put(const std::string& sha256, const std::string& bytes);
    /// Does not read the file.
    std::optional<std::filesystem::path> find(const std::string& sha256) const;
    /// Of its file; 0 if there is none. Does not read it.
    std::int64_t size_bytes(const std::string& sha256) const;
    /// The file, completely read and checked against its hash. Throws DamagedData. The result is not cached, since a
    /// disk that loses bits changes neither time nor size of a file; it takes a millisecond per megabyte.
    ContentPtr open(const std::string& sha256) const;
    /// Whether open() would succeed.
    bool is_whole(const std::string& sha256) const;
    void remove(const std::string& sha256);
    /// Removes unfinished files of killed writers: those older than `age`.
    void remove_leftovers(std::chrono::seconds age);
    /// The names of all complete files.
    std::vector<std::string> list() const;

  private:
    std::filesystem::path place_of(const std::string& sha256) const;

    std::filesystem::path m_folder;
};

}  // namespace sheer
