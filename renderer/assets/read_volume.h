#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

inline constexpr int max_volume_side = 1024;
/// Of the voxels in memory: a byte each for uint8, four for every other type.
inline constexpr std::size_t max_volume_bytes = std::size_t{512} << 20;

/// A volume file: NRRD, unless `raw` says what the bytes are.
///
/// NRRD ("Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html): dimension 3, the data in the same
/// file; type uint8, int16, uint16 or float; encoding raw or gzip; either endian; spacings, or the lengths of the space
/// directions. Other fields are passed over.
///
/// Values become 0..1: uint8 and uint16 are divided by their greatest value; int16 and floats go from 0 for the least
/// value of the file to 1 for the greatest, and are 0 where all are equal.
///
/// Throws AssetError for what is not such a file, sides over max_volume_side, more than max_volume_bytes, too few or
/// too many bytes of voxels, and floats that are not finite.
Volume read_volume(std::string_view bytes, const std::optional<RawVolume>& raw);

/// Size, spacing, type and encoding of an NRRD file, whose voxels are read too. Throws as read_volume.
nlohmann::json describe_nrrd(std::string_view bytes);

}  // namespace sheer
