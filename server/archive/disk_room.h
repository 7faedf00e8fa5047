#pragma once
#include <cstdint>
#include <string>

#include "server/storage/data_folder.h"

namespace sheer {

/// The size and the free space of a disk.
struct DiskSpace {
    std::uint64_t total_bytes = 0, free_bytes = 0;
    std::uint64_t total_inodes = 0, free_inodes = 0;  ///< a total of 0: the file system does not count them
};

/// What new work must leave free: a quarter of the disk, but at most 32 MiB; an eighth of the inodes, but at most 64.
std::uint64_t least_free_bytes(const DiskSpace& space);
std::uint64_t least_free_inodes(const DiskSpace& space);
/// Why there is too little room for new work, as a message; "" if there is enough.
std::string lack_of_room(const DiskSpace& space);

/// Manages the room on the disk of an archive. A reserve, which is a file, is given up if even a deletion does not find
/// the room that it needs, and is made again when there is enough. Can be shared by processes.
class DiskRoom {
  public:
    explicit DiskRoom(DataFolder folder) : m_folder(std::move(folder)) {}

    /// See lack_of_room(DiskSpace).
    std::string lack() const;
    /// Returns whether there was one.
    bool give_up_reserve();
    /// Makes the reserve if it does not exist and the disk has room for it.
    void restore_reserve();

  private:
    DiskSpace space() const;

    DataFolder m_folder;
};

}  // namespace sheer
