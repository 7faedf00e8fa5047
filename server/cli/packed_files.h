#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace sheer::cli {

/// Writes the files below `folder` as a tar file, which appears when it is complete. Throws std::runtime_error.
void write_tar(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Writes the files of a tar file below `folder`, which must exist; those whose name `wanted` refuses are errors.
/// Throws std::runtime_error, also for a file that is no complete tar file.
void extract_tar(const std::filesystem::path& file, const std::filesystem::path& folder,
                 const std::function<bool(const std::string& name)>& wanted);

/// The bytes of the first file in a ZIP file whose name `wanted` accepts; nothing if there is none. Throws
/// std::runtime_error, also for a longer one.
std::optional<std::string> read_zipped(const std::filesystem::path& file,
                                       const std::function<bool(const std::string& name)>& wanted,
                                       std::uint64_t max_bytes);

}  // namespace sheer::cli
