#pragma once
#include <string>

#include "renderer/image/image.h"
#include "renderer/image/pixel_counts.h"
#include "renderer/results/report.h"

namespace sheer {

/// Takes the pictures of a report while it is made. Each call returns the report's entry for the picture. `name` is a
/// file name and unique in the report.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    virtual report::Picture take(const Image8& picture, const std::string& name) = 0;
    virtual report::Picture take(const Image& picture, const std::string& name) = 0;
    virtual report::Picture take(const PixelCounts& counts, const std::string& name) = 0;
};

}  // namespace sheer
