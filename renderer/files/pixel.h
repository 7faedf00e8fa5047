#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/autopsy.h"

namespace sheer {

/// Gives the bytes of a picture by its image object.
using PictureReader = std::function<std::string(const nlohmann::json& image)>;

/// What a pixel is made of and what each method made of it, as GET /reports/{id}/pixel answers. `stack` is that of the
/// pixel (x, y), `run` the run of the report that has its pictures. Throws what `read_picture` throws, and
/// std::runtime_error for pictures that cannot be read.
///
/// Values are red, green, blue as in the picture, 0..1 where nothing is over; `difference` is the exact sum minus the
/// value, as in the metric `signed`. Counts come from the report's pictures of counts; null, with a reason, where these
/// cannot tell them apart. `explanation` holds each method's own facts, [{name, kind, value, text}], of the pixel as it
/// was drawn again, `explained_value`; null, with a reason, where it could not be.
nlohmann::json pixel_report(const PixelStack& stack, int x, int y, const nlohmann::json& run,
                            const PictureReader& read_picture);

/// The same for the terminal.
std::string pixel_table(const nlohmann::json& pixel);

}  // namespace sheer
