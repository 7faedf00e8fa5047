#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "server/jobs/store.h"

namespace sheer {

/// Files named by the SHA-256 of their bytes: FOLDER/ab/ab12... A file is there whole and on the disk, or not at all.
class BlobStore {
  public:
    /// Makes the folder if need be. Throws StoreError.
    explicit BlobStore(std::filesystem::path folder);

    /// Keeps `bytes`, also in place of a file that is damaged; does nothing if they are there already. Returns whether
    /// it wrote them. Throws StoreFull, and StoreError, also if `sha256` is not theirs.
    bool put(const std::string& sha256, const std::string& bytes);
    /// Does not read the file.
    std::optional<std::filesystem::path> find(const std::string& sha256) const;
    /// The file, read whole: its bytes have this hash. Throws DamagedFile. Nothing is remembered of it, since a disk
    /// that loses bits changes no time and no size; it takes a millisecond for each megabyte.
    std::filesystem::path find_whole(const std::string& sha256) const;
    void remove(const std::string& sha256);
    /// Removes the unfinished files of writers that were killed: those older than `age`.
    void remove_leftovers(std::chrono::seconds age);

  private:
    std::filesystem::path m_folder;
};

/// Where the blob of this hash lies in a BlobStore's folder. Throws StoreError if `sha256` is not one.
std::filesystem::path blob_path(const std::filesystem::path& folder, const std::string& sha256);

/// Of the bytes of a file, as 64 digits. Throws StoreError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

/// Whether `text` is 64 digits of lower-case hexadecimal.
bool is_sha256(const std::string& text);

/// The bytes of a file. Throws StoreError if it cannot be read or is longer than `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes);

}  // namespace sheer
