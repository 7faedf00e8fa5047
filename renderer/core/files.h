#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace sheer {

/// The bytes of a file. Throws std::runtime_error, naming it, if it does not exist or is longer than `max_bytes`;
/// std::system_error if reading fails.
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

/// Throws WriteError, naming the file.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sheer
