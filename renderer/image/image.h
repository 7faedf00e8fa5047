#pragma once
#include <cstdint>
#include <vector>

namespace sheer {

/// A picture in floats: rows from the top down, 4 interleaved channels (red, green, blue, alpha). Values are as the
/// method left them: usually 0..1, but values over 1 and non-finite ones are kept.
struct Image {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> rgba;  ///< width * height * 4

    Image() = default;
    Image(int width, int height) : width_px(width), height_px(height), rgba(std::size_t(width) * height * 4, 0.0f) {}
    const float* pixel(int x, int y) const { return &rgba[(std::size_t(y) * width_px + x) * 4]; }
    float* pixel(int x, int y) { return &rgba[(std::size_t(y) * width_px + x) * 4]; }
    std::size_t pixel_count() const { return std::size_t(width_px) * height_px; }
};

/// A picture as it is shown: rows from the top down, 3 interleaved channels of 8 bits, sRGB-encoded.
struct Image8 {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::uint8_t> rgb;  ///< width * height * 3

    Image8() = default;
    Image8(int width, int height) : width_px(width), height_px(height), rgb(std::size_t(width) * height * 3, 0) {}
    const std::uint8_t* pixel(int x, int y) const { return &rgb[(std::size_t(y) * width_px + x) * 3]; }
    std::uint8_t* pixel(int x, int y) { return &rgb[(std::size_t(y) * width_px + x) * 3]; }
    std::size_t pixel_count() const { return std::size_t(width_px) * height_px; }
};

/// RGB to 8 bits: clamped to 0..1, times 255, rounded to nearest, halves up. No transfer function is applied: the
/// methods blend display-referred values, as in the paper. NaN becomes 0.
Image8 quantize(const Image& image);

}  // namespace sheer
