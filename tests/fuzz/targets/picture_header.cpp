#include "renderer/assets/picture_header.h"

#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// PNG, JPEG, OpenEXR and WebP: whatever a header says, its picture has a size within the limits.
void read_header(std::string_view input) {
    read_or_refuse<AssetError>([&] {
        const PictureHeader header = read_picture_header(input);
        require(header.width_px >= 1 && header.width_px <= max_picture_side_px, "a width outside the limits");
        require(header.height_px >= 1 && header.height_px <= max_picture_side_px, "a height outside the limits");
        require(header.orientation >= 1 && header.orientation <= 8, "an orientation that does not exist");
    });
}

}  // namespace

FuzzTarget fuzz_picture_header() {
    return {"picture_header", read_header};
}

}  // namespace sheer::test
