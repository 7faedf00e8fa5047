#include "server/archive/disk_room.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>

namespace sheer {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kibibyte = 1024, mebibyte = 1024 * kibibyte;

/// A deletion writes some fifty pages to SQLite's log before it frees anything.
std::uint64_t reserve_bytes(const DiskSpace& space) {
    return std::clamp<std::uint64_t>(space.total_bytes / 16, 256 * kibibyte, 4 * mebibyte);
}

}  // namespace

std::uint64_t least_free_bytes(const DiskSpace& space) {
    return std::min<std::uint64_t>(space.total_bytes / 4, 32 * mebibyte);
}

std::uint64_t least_free_inodes(const DiskSpace& space) {
    return std::min<std::uint64_t>(space.total_inodes / 8, 64);
}

std::string lack_of_room(const DiskSpace& space) {
    if (space.free_bytes < least_free_bytes(space))
        return fmt::format("the archive's disk has {} KiB left but needs {} KiB", space.free_bytes / kibibyte,
                           least_free_bytes(space) / kibibyte);
    if (space.total_inodes > 0 && space.free_inodes < least_free_inodes(space))
        return fmt::format("the archive's disk has inodes for {} more files but needs {}", space.free_inodes,
                           least_free_inodes(space));
    return "";
}

std::string DiskRoom::lack() const {
    return lack_of_room(space());
}

bool DiskRoom::give_up_reserve() {
    if (unlink(m_folder.reserve().c_str()) != 0) return false;
    spdlog::warn("the archive's disk is full: its reserve is given up");
    return true;
}

void DiskRoom::restore_reserve() {
    std::error_code none;
    const DiskSpace now = space();
    const std::uint64_t wanted = reserve_bytes(now);
    if (fs::file_size(m_folder.reserve(), none) >= wanted && !none) return;
    if (now.free_bytes < least_free_bytes(now) + wanted) return;
    const int file = open(m_folder.reserve().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) return;
    const bool made = posix_fallocate(file, 0, static_cast<off_t>(wanted)) == 0;
    close(file);
    if (!made) unlink(m_folder.reserve().c_str());
}

DiskSpace DiskRoom::space() const {
    struct statvfs status {};
    // A disk that does not report its space is assumed to have room: writing will show.
    if (statvfs(m_folder.root.c_str(), &status) != 0) return {};
    return {.total_bytes = status.f_blocks * status.f_frsize,
            .free_bytes = status.f_bavail * status.f_frsize,
            .total_inodes = status.f_files,
            .free_inodes = status.f_favail};
}

}  // namespace sheer
