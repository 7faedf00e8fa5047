#include <cmath>

#include "renderer/assets/read_volume.h"
#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// NRRD: a volume that is not refused has a value of 0 to 1 for each voxel.
void read_nrrd(std::string_view input) {
    read_or_refuse<AssetError>([&] {
        const Volume volume = read_volume(input, {});
        require(volume.floats.size() + volume.bytes.size() == volume.voxel_count(), "another number of voxels");
        for (const float value : volume.floats) require(value >= 0 && value <= 1, "a value outside 0 to 1");
    });
}

}  // namespace

FuzzTarget fuzz_volume() {
    return {"volume", read_nrrd};
}

}  // namespace sheer::test
