#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/frame/image.h"
#include "renderer/frame/pixel_counts.h"

namespace sheer {

/// Takes the pictures of a report while it is made. Each call gives what the report then says of the picture:
/// {sha256, url, media_type}. `name` is a file's name and unique in the report.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    virtual nlohmann::json take(const Image8& picture, const std::string& name) = 0;
    virtual nlohmann::json take(const Image& picture, const std::string& name) = 0;
    virtual nlohmann::json take(const PixelCounts& counts, const std::string& name) = 0;
};

}  // namespace sheer
