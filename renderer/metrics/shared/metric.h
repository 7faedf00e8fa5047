#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/image/image.h"

namespace sheer {

/// A scene's picture over a black and over a white background, all else equal: the difference is what shows of the
/// background.
struct Backdrops {
    Image black, white;
};

/// What a comparison may have beside the two pictures; null if it was not rendered.
struct MorePictures {
    const Backdrops* reference_over = nullptr;
    const Backdrops* test_over = nullptr;
    /// The reference rounded by the device to the format of the test picture.
    const Image* reference_as_shown = nullptr;
    const std::vector<Image8>* test_frames = nullptr;  ///< consecutive ones, in which nothing moves
};

/// The two pictures of a comparison, same size. The float pictures are as the methods left them; the 8-bit ones are
/// their quantization, except that a non-finite channel of `test8` holds the value furthest from the reference (0 or
/// 255), so that a broken method never scores better than a wrong one.
struct ImagePair {
    const Image& reference;
    const Image& test;
    Image8 reference8;  ///< of the reference as shown
    Image8 test8;
    MorePictures more;

    /// `reference8` is made from `reference_as_shown`, if there is one. Throws std::invalid_argument if the sizes
    /// differ or if a picture is empty or has more or fewer values than its size requires.
    ImagePair(const Image& reference_image, const Image& test_image, const MorePictures& more_pictures = {});
};

/// Which of two values of a field is the better one.
enum class Better { none, lower, higher, nearer_zero };

/// A field's column in the tables that `sheer compare` prints.
struct TerminalColumn {
    std::string head;  ///< short, with the unit; "" for no column
    int decimals = 3;
};

/// How a field is shown: the tables and charts of the page and the terminal's tables have no other list of columns.
struct MetricColumn {
    std::string head;  ///< on the page; "" for no column
    Better better = Better::none;
    int digits = 3;    ///< significant digits of the smallest value; the others of the column have as many decimals
    std::string note;  ///< field of the same metric that is shown after the value
    TerminalColumn terminal = {};
};

/// One value of a metric, as checks name it: "flip.mean", or "rmse" if the metric is a single number.
struct MetricField {
    enum class Kind { number, count, pixel, text };

    std::string name;  ///< "" if the metric's value is the field itself
    Kind kind = Kind::number;
    std::string unit;
    std::string range;  ///< e.g. "0..1"
    std::string summary;
    bool null_is_identical = false;  ///< it is null if the pictures are identical, which is the best value
    MetricColumn column = {};

    /// A number or null, so that a check can bound it.
    bool is_number() const { return kind == Kind::number || kind == Kind::count; }
};

/// The result of a metric for one pair.
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
    std::string formula;  ///< in the letters that docs/metrics.md explains
    std::string good_for;
    std::string picture;  ///< key of its picture in the report's `images`, "" if it makes none
    int place = 100;      ///< metrics are listed, and have their columns, in the order of their places
    std::vector<MetricField> fields;
    std::function<MetricValue(const ImagePair&)> compute;
};

/// As checks and reports name the field: "flip.mean", or "rmse".
std::string full_name(const MetricInfo& metric, const MetricField& field);

/// Every metric, from the generated table, by place and then by id.
const std::vector<MetricInfo>& all_metrics();

/// The values of all metrics by id, and the pictures by their key. Throws std::invalid_argument as ImagePair does.
struct Metrics {
    nlohmann::json values;
    std::vector<std::pair<std::string, Image8>> pictures;
};
Metrics compute_metrics(const Image& reference, const Image& test, const MorePictures& more = {});

}  // namespace sheer
