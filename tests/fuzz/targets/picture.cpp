#include <cmath>

#include "renderer/assets/picture_file.h"
#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// A picture that is not refused is complete and finite.
void read_pixels(std::string_view input) {
    read_or_refuse<AssetError>([&] {
        const Picture picture = read_picture(input, 4, 4);
        require(picture.image.rgba.size() == 4 * 4 * 4, "a picture of another size");
        for (const float value : picture.image.rgba) require(std::isfinite(value) && value >= 0, "a value not finite");
    });
}

}  // namespace

FuzzTarget fuzz_picture() {
    return {"picture", read_pixels};
}

}  // namespace sheer::test
