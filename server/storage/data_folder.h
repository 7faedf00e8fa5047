#pragma once
#include <filesystem>

namespace sheer {

/// The layout of the folder of a service and its workers.
struct DataFolder {
    std::filesystem::path root;

    std::filesystem::path database() const { return root / "archive.sqlite"; }
    /// Pictures, by their SHA-256.
    std::filesystem::path blobs() const { return root / "blobs"; }
    /// Uploaded files, by their SHA-256.
    std::filesystem::path assets() const { return root / "assets"; }
    /// Output of renderers until it is committed.
    std::filesystem::path scratch() const { return root / "scratch"; }
    /// Compiled shaders that drivers keep from one job to the next.
    std::filesystem::path shaders() const { return root / "shaders"; }
    /// What a repair has set aside.
    std::filesystem::path quarantine() const { return root / "quarantine"; }
    /// A file that reserves space, which is given up if a deletion needs it.
    std::filesystem::path reserve() const { return root / "reserve"; }
};

}  // namespace sheer
