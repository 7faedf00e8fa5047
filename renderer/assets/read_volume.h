#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

inline constexpr int max_volume_side = 1024;
/// Of the voxels in memory: a byte each for uint8, four for every other type.
inline constexpr std::size_t max_volume_bytes = std::size_t{512} << 20;

/// Gives the bytes of the file that a detached NRRD header names. Throws AssetError where it may not. Empty: no such
/// file is read.
using DataFiles = std::function<std::string(const std::string& name)>;

/// A volume file: NRRD, unless the options say what the bytes are.
///
/// NRRD ("Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html): dimension 3, the data attached or in
/// one other file; whole numbers of 8 to 32 bits, float or double; encoding raw, ascii, hex, gzip or bzip2; either
/// endian; line skip and byte skip; spacings, or space directions, by which the voxels are put in order, see
/// renderer/assets/nrrd_axes.h. Notes tell of what else matters.
///
/// Values become 0..1 from the first to the second of the options' range; without one, from the least to the greatest
/// of the file, and are 0 where all are equal. A note says which they were.
///
/// Throws AssetError for what is not such a file, sides over max_volume_side, more than max_volume_bytes, too few or
/// too many bytes of voxels, and numbers that are not finite.
Volume read_volume(std::string_view bytes, const VolumeOptions& options, const DataFiles& data_files = {});

/// Size, spacing, type, encoding and range of values of an NRRD file with its data attached. Throws as read_volume.
nlohmann::json describe_nrrd(std::string_view bytes);

}  // namespace sheer
