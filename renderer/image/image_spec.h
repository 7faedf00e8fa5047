#pragma once
#include <array>
#include <string>

namespace sheer {

/// What the methods blend into.
enum class PixelFormat { rgba8, rgba16f, rgba32f };
inline constexpr std::array pixel_formats = {PixelFormat::rgba8, PixelFormat::rgba16f, PixelFormat::rgba32f};
/// As a spec names it.
std::string to_string(PixelFormat format);
/// Throws std::invalid_argument if none has that name.
PixelFormat pixel_format_named(const std::string& name);

struct ImageSpec {
    int width_px = 512;
    int height_px = 512;
    std::array<float, 3> background{};  ///< 0..1
    PixelFormat format = PixelFormat::rgba8;
};

}  // namespace sheer
