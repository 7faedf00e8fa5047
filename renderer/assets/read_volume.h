#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

inline constexpr int max_volume_side = 1024;
/// The memory for the voxels: a byte each for uint8, four for every other type.
inline constexpr std::size_t max_volume_bytes = std::size_t{512} << 20;

/// Returns the bytes of the file that a detached NRRD header names. Throws AssetError if it must not be read. Empty: no
/// such file is read.
using DataFiles = std::function<std::string(const std::string& name)>;

/// A volume file: NRRD, unless the options say what the bytes are.
///
/// NRRD ("Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html): dimension 3, the data attached or in
/// one other file; whole numbers of 8 to 32 bits, float or double; encoding raw, ascii, hex, gzip or bzip2; either
/// endian; line skip and byte skip; spacings, or space directions, which decide the order of the voxels, see
/// renderer/assets/nrrd_axes.h. Notes mention whatever else matters.
///
/// Values from the first to the second number of the options' range become 0..1; without one, from the least to the
/// greatest of the file. If all are equal they become 0. A note gives the range.
///
/// Throws AssetError for any other file, sides over max_volume_side, more than max_volume_bytes, too few or too many
/// bytes of voxels, and numbers that are not finite.
Volume read_volume(std::string_view bytes, const VolumeOptions& options, const DataFiles& data_files = {});

/// Size, spacing, type, encoding and range of values of an NRRD file with its data attached. Throws as read_volume.
nlohmann::json describe_nrrd(std::string_view bytes);

}  // namespace sheer
