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

FloatErrors over_checker(const Backdrops& reference, const Backdrops& test) {
    FloatErrors errors;
    for (int y = 0; y < reference.black.height_px; ++y)
        for (int x = 0; x < reference.black.width_px; x += square_px) {
            const bool white = (x / square_px + y / square_px) % 2 == 1;
            const int width = std::min(square_px, reference.black.width_px - x);
            errors.add((white ? reference.white : reference.black).pixel(x, y),
                       (white ? test.white : test.black).pixel(x, y), static_cast<std::size_t>(width));
        }
    return errors;
}

nlohmann::json nothing(const std::string& reason) {
    return {{"worst", nullptr}, {"rmse", nullptr},    {"max_abs", nullptr}, {"black", nullptr},
            {"white", nullptr}, {"checker", nullptr}, {"reason", reason}};
}

MetricValue compute(const ImagePair& pair) {
    if (!pair.reference_over || !pair.test_over)
        return {nothing("the pictures over black and white were not rendered"), std::nullopt};
    const Backdrops &reference = *pair.reference_over, &test = *pair.test_over;
    const std::array<Named, 3> all = {{{"black", float_errors(reference.black, test.black)},
                                       {"white", float_errors(reference.white, test.white)},
                                       {"checker", over_checker(reference, test)}}};
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
    value["worst"] = worst->name;
    value["rmse"] = worst->errors.rmse();
    value["max_abs"] = greatest;
    return {value, std::nullopt};
}

}  // namespace

MetricInfo metric_over_backgrounds() {
    return {
        "over_backgrounds",
        "Over other backgrounds",
        "Differences of the float pictures rendered over black, over white and over a checker of 8 px, so that a "
        "wrong alpha shows whatever the background of the comparison is. Null with a reason where a value is not "
        "finite.",
        "Porter, Duff, Compositing Digital Images, SIGGRAPH 1984: a pixel over a background B is C + T B",
        "",
        {{"worst", "", "black, white or checker", "The background with the greatest error; of equals the first", false},
         {"rmse", "", "0..", "Root mean square error over the worst background"},
         {"max_abs", "", "0..", "Greatest absolute difference of a channel over any of them"},
         {"black", "", "0..", "Root mean square error over black"},
         {"white", "", "0..", "Root mean square error over white"},
         {"checker", "", "0..", "Root mean square error over the checker"}},
        compute};
}

}  // namespace sheer
