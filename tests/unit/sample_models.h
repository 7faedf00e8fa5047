#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/glb_writer.h"

namespace sheer::test {

/// A colour that must be seen at a pixel, in display values 0..1.
struct ExpectedPixel {
    int x_px, y_px;
    std::array<double, 3> color;
};

/// A small model of one of the kinds that the glTF sample collections have, and what a viewer shows of it.
struct SampleModel {
    std::string name;
    std::function<void(GlbWriter&)> make;
    std::vector<ExpectedPixel> expected;              ///< in a picture of sample_size_px a side over sample_background
    nlohmann::json scene = nlohmann::json::object();  ///< fields of the spec's scene, in place of those of sample_scene
    double tolerance = 0.6 / 255;
};

inline constexpr int sample_size_px = 32;
inline constexpr std::array<double, 3> sample_background = {0.2, 0.4, 0.6};

/// Looked at along z; -1..1 of the plane z = 0 fill the picture. Without light.
nlohmann::json sample_scene();

/// All of them; each name once.
const std::vector<SampleModel>& sample_models();

inline void PrintTo(const SampleModel& sample, std::ostream* out) {
    *out << sample.name;
}

}  // namespace sheer::test
