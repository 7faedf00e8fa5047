#include "renderer/scene/picture_arrays.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheer::picture_arrays_test {

namespace {

using Sizes = std::vector<glm::ivec2>;

std::size_t texels_of(const PictureArrays& arranged) {
    std::size_t texels = 0;
    for (const PictureArrays::Array& array : arranged.arrays)
        texels += std::size_t(array.size_px.x) * std::size_t(array.size_px.y) * std::size_t(array.layers);
    return texels;
}

/// Every picture is in an array at a level of its size, and no two share a place.
void expect_sound(const PictureArrays& arranged) {
    EXPECT_LE(arranged.arrays.size(), max_picture_arrays);
    EXPECT_LE(texels_of(arranged), max_model_texels);
    std::vector<std::pair<int, int>> taken;
    for (std::size_t i = 0; i < arranged.places.size(); ++i) {
        const PictureArrays::Place& place = arranged.places[i];
        const PictureArrays::Array& array = arranged.arrays.at(static_cast<std::size_t>(place.array));
        EXPECT_EQ(glm::max(array.size_px >> place.level, glm::ivec2(1)), arranged.sizes_px[i]);
        EXPECT_LT(place.layer, array.layers);
        taken.emplace_back(place.array, place.layer);
    }
    std::ranges::sort(taken);
    EXPECT_EQ(std::ranges::adjacent_find(taken), taken.end());
    EXPECT_EQ(arrange_pictures(arranged.sizes_px).sizes_px, arranged.sizes_px);
}

TEST(PictureArrays, KeepSizesApart) {
    const PictureArrays arranged = arrange_pictures({{4, 4}, {100, 30}, {4, 4}, {7, 3}});
    expect_sound(arranged);
    EXPECT_EQ(arranged.arrays.size(), 3u);
    EXPECT_EQ(arranged.sizes_px, Sizes({{4, 4}, {100, 30}, {4, 4}, {7, 3}}));
    EXPECT_TRUE(arrange_pictures({}).arrays.empty());
}

/// Eight sizes, but all but two are mipmaps of the largest ones.
TEST(PictureArrays, PutPicturesAtTheLevelOfTheirSize) {
    const Sizes sizes = {{64, 64}, {32, 32}, {16, 16}, {8, 8}, {4, 4}, {100, 50}, {50, 25}, {25, 12}};
    const PictureArrays arranged = arrange_pictures(sizes);
    expect_sound(arranged);
    EXPECT_EQ(arranged.sizes_px, sizes);
}

TEST(PictureArrays, ScaleTheSmallestOfTooManySizes) {
    const PictureArrays arranged = arrange_pictures({{4, 3}, {5, 4}, {7, 7}, {11, 11}, {13, 13}, {17, 17}, {7, 7}});
    expect_sound(arranged);
    EXPECT_EQ(arranged.sizes_px, Sizes({{5, 4}, {5, 4}, {7, 7}, {11, 11}, {13, 13}, {17, 17}, {7, 7}}));
}

TEST(PictureArrays, HalveTooLargePictures) {
    EXPECT_EQ(arrange_pictures({{8192, 1024}}).sizes_px, Sizes({{2048, 256}}));
    // Of five pictures with 4 million texels each, at most four fit.
    expect_sound(arrange_pictures(Sizes(5, {2048, 2048})));
    Sizes many;
    for (int i = 0; i < 256; ++i) many.emplace_back(8192 - 4 * i, 1 + 28 * i);
    expect_sound(arrange_pictures(many));
}

}  // namespace

}  // namespace sheer::picture_arrays_test
