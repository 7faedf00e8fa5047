#pragma once
#include <string>

#include "renderer/compare/pixel.h"
#include "renderer/results/pixel_types.h"
#include "renderer/results/report.h"

namespace sheer {

/// The fragments of a pixel and each method's result. `stack` belongs to the pixel (x, y), `run` is the run of the
/// report that has its pictures. Counts come from the report's pictures of counts. Throws what `read_picture` throws,
/// and std::runtime_error for pictures that are missing or cannot be read.
pixel::Pixel pixel_report(const PixelStack& stack, int x, int y, const report::Run& run,
                          const report::PictureReader& read_picture);

/// The same for the terminal.
std::string pixel_table(const pixel::Pixel& pixel);

}  // namespace sheer
