#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/frame/image.h"

namespace sheer {

/// A scene's picture over a black and over a white background, all else equal: what is left of the background shows.
struct Backdrops {
    Image black, white;
};

/// The two pictures of a comparison, same size. The float pictures are what the methods left; the 8-bit ones are their
/// quantization, except that a non-finite channel of `test8` holds the value furthest from the reference (0 or 255), so
/// that a broken method never scores better than a wrong one.
struct ImagePair {
    const Image& reference;
    const Image& test;
    Image8 reference8;  ///< of the reference as it is shown
    Image8 test8;
    const Backdrops* reference_over;  ///< null where they were not rendered
    const Backdrops* test_over;

    /// `reference_as_shown` is what `reference8` is made from: the reference rounded to the format that the test
    /// picture had, as the device rounds; null for the reference itself. Throws std::invalid_argument if the sizes
    /// differ or a picture is empty or not as long as its size says.
    ImagePair(const Image& reference_image, const Image& test_image, const Backdrops* reference_backdrops = nullptr,
              const Backdrops* test_backdrops = nullptr, const Image* reference_as_shown = nullptr);
};

/// One value of a metric, as checks name it: "flip.mean", or "rmse" where the metric is a single number.
struct MetricField {
    std::string name;  ///< "" where the metric's value is the field itself
    std::string unit;
    std::string range;  ///< e.g. "0..1"
    std::string summary;
    bool is_number = true;  ///< a number or null, so that a check can bound it; worst_pixel is a pair
};

/// What a metric gives for one pair.
struct MetricValue {
    nlohmann::json value;           ///< a number, null, an array or an object with the fields
    std::optional<Image8> picture;  ///< a map to look at, same size as the pair
};

/// A metric describes itself; the file renderer/metrics/<id>.cpp ends with `MetricInfo metric_<id>()`.
struct MetricInfo {
    std::string id;  ///< key in the report's `metrics`
    std::string name;
    std::string summary;
    std::string source;   ///< paper or standard
    std::string picture;  ///< key of its picture in the report's `images`, "" if it makes none
    std::vector<MetricField> fields;
    std::function<MetricValue(const ImagePair&)> compute;
};

/// Every metric, from the generated table.
const std::vector<MetricInfo>& all_metrics();

/// The values of all metrics by id, and the pictures by their key. Throws std::invalid_argument as ImagePair does.
struct Metrics {
    nlohmann::json values;
    std::vector<std::pair<std::string, Image8>> pictures;
};
Metrics compute_metrics(const Image& reference, const Image& test, const Backdrops* reference_over = nullptr,
                        const Backdrops* test_over = nullptr, const Image* reference_as_shown = nullptr);

}  // namespace sheer
