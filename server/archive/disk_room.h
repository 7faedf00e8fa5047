#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace sheer {

/// What is free on a disk, and what of it should stay so.
struct DiskSpace {
    std::uint64_t total_bytes = 0, free_bytes = 0;
    std::uint64_t total_inodes = 0, free_inodes = 0;  ///< no total: the file system does not count them
};

/// What new work must leave free: a quarter of the disk, 32 MiB at most; an eighth of the inodes, 64 at most.
std::uint64_t least_free_bytes(const DiskSpace& space);
std::uint64_t least_free_inodes(const DiskSpace& space);
/// Why there is too little room for new work, for whoever asks; "" if there is enough.
std::string lack_of_room(const DiskSpace& space);

/// Looks after the room on the disk of an archive. A reserve, the file FOLDER/reserve, is given up when even a deletion
/// does not find the room that it needs, and is made again when there is enough. Safe to share by processes.
class DiskRoom {
  public:
    explicit DiskRoom(std::filesystem::path folder);

    /// See lack_of_room(DiskSpace).
    std::string lack() const;
    /// Returns whether there was one.
    bool give_up_reserve();
    /// Makes the reserve if it is not there and the disk has room for it.
    void restore_reserve();

  private:
    DiskSpace space() const;

    std::filesystem::path m_folder, m_reserve;
};

}  // namespace sheer
