#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/glb_writer.h"

namespace sheer::test {

/// The expected color of a pixel, in display values 0..1.
struct ExpectedPixel {
    int x_px, y_px;
    std::array<double, 3> color;
};

/// A small model of a kind found in the glTF sample collections, and what a viewer shows.
struct SampleModel {
    std::string name;
    std::function<void(GlbWriter&)> make;
    std::vector<ExpectedPixel> expected;              ///< in a square picture of sample_size_px over sample_background
    nlohmann::json scene = nlohmann::json::object();  ///< fields of the spec's scene that replace those of sample_scene
    double tolerance = 0.6 / 255;
};

inline constexpr int sample_size_px = 32;
inline constexpr std::array<double, 3> sample_background = {0.2, 0.4, 0.6};

/// Viewed along z; -1..1 of the plane z = 0 fill the picture. Without lighting.
nlohmann::json sample_scene();

/// All samples; names are unique.
const std::vector<SampleModel>& sample_models();

inline void PrintTo(const SampleModel& sample, std::ostream* out) {
    *out << sample.name;
}

}  // namespace sheer::test
