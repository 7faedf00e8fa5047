#pragma once
#include <filesystem>

#include "renderer/compare/compare.h"
#include "renderer/pictures/blob_sink.h"

namespace sheer {

/// The file below a renderer's folder that lists the pictures of the point that is being timed:
/// {"point": {...}, "pictures": [{"label", "sha256"}]}.
inline constexpr const char* early_pictures_file = "early.json";

/// Writes the colors of the reference and of each method that has some, and lists them in the folder's
/// early_pictures_file, which is replaced at once. Throws WriteError.
void write_early_pictures(const Run& run, PictureSink& pictures, const std::filesystem::path& folder);

}  // namespace sheer
