#include "renderer/image/image_spec.h"

#include <stdexcept>

namespace sheer {

std::string to_string(PixelFormat format) {
    switch (format) {
        case PixelFormat::rgba8:
            return "rgba8";
        case PixelFormat::rgba16f:
            return "rgba16f";
        case PixelFormat::rgba32f:
            return "rgba32f";
    }
    throw std::logic_error("unknown pixel format");
}

PixelFormat pixel_format_named(const std::string& name) {
    for (const PixelFormat format : pixel_formats)
        if (to_string(format) == name) return format;
    throw std::invalid_argument("there is no pixel format " + name);
}

}  // namespace sheer
