// What a single background hides: a wrong transmittance shows nothing over black and everything over white. So both
// pictures are compared over black, white and a checker, and the worst counts.
// The checker's picture has each pixel from that over black or that over white: what a pixel shows is C + T B, and the
// two give C and C + T.

#include <algorithm>
#include <array>

#include "renderer/metrics/float_errors.h"
#include "renderer/metrics/metric.h"

namespace sheer {
namespace {

constexpr int square_px = 8;

struct Named {
    const char* name;
    FloatErrors errors;
};

/// Over black, white and the checker, in this order.
std::array<Named, 3> errors_over(const Backdrops& reference, const Backdrops& test) {
    std::array<Named, 3> all = {{{"black", {}}, {"white", {}}, {"checker", {}}}};
    const int width = reference.black.width_px, height = reference.black.height_px;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; x += square_px) {
            const auto pixels = static_cast<std::size_t>(std::min(square_px, width - x));
            FloatErrors black, white;
            black.add(reference.black.pixel(x, y), test.black.pixel(x, y), pixels);
            white.add(reference.white.pixel(x, y), test.white.pixel(x, y), pixels);
            all[0].errors += black;
            all[1].errors += white;
            all[2].errors += (x / square_px + y / square_px) % 2 == 0 ? black : white;
        }
    return all;
}

nlohmann::json nothing(const std::string& reason) {
    return {{"worst", nullptr}, {"rmse", nullptr},    {"max_abs", nullptr}, {"black", nullptr},
            {"white", nullptr}, {"checker", nullptr}, {"reason", reason}};
}

MetricValue compute_over_backgrounds(const ImagePair& pair) {
    if (!pair.reference_over || !pair.test_over)
        return {nothing("the pictures over black and white were not rendered"), std::nullopt};
    const std::array<Named, 3> all = errors_over(*pair.reference_over, *pair.test_over);
    nlohmann::json value = nlohmann::json::object();
    const Named* worst = all.data();
    double greatest = 0;
    for (const Named& one : all) {
        if (!one.errors.finite())
            return {nothing(std::string("over ") + one.name + " a picture has a NaN or an infinity"), std::nullopt};
        value[one.name] = one.errors.rmse();
        greatest = std::max(greatest, one.errors.greatest);
        if (one.errors.rmse() > worst->errors.rmse()) worst = &one;
    }
    value["rmse"] = worst->errors.rmse();
    value["worst"] = greatest > 0 ? nlohmann::json(worst->name) : nlohmann::json();
    value["max_abs"] = greatest;
    return {value, std::nullopt};
}

}  // namespace

MetricInfo metric_over_backgrounds() {
    return {"over_backgrounds",
            "Over other backgrounds",
            "Differences of the float pictures rendered over black, over white and over a checker of 8 px, so that a "
            "wrong alpha shows whatever the background of the comparison is. Null with a reason where a value is not "
            "finite.",
            "Porter, Duff, Compositing Digital Images, SIGGRAPH 1984: a pixel over a background B is C + T B",
            "",
            {{"worst", "", "black, white or checker",
              "The background with the greatest error; of equals the first, null where nothing differs", false},
             {"rmse", "", "0..", "Root mean square error over the worst background"},
             {"max_abs", "", "0..", "Greatest absolute difference of a channel over any of them"},
             {"black", "", "0..", "Root mean square error over black"},
             {"white", "", "0..", "Root mean square error over white"},
             {"checker", "", "0..", "Root mean square error over the checker"}},
            compute_over_backgrounds};
}

}  // namespace sheer
