// Errors that a single background hides: a wrong transmittance is invisible over black and fully visible over white. So
// both pictures are compared over black, white and a checker, and the worst counts.
// The picture over the checker takes each pixel from the one over black or the one over white: a pixel is C + T B, and
// these two give C and C + T.

#include <algorithm>
#include <array>

#include "renderer/metrics/shared/float_errors.h"
#include "renderer/metrics/shared/metric.h"

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
    if (!pair.more.reference_over || !pair.more.test_over)
        return {nothing("the pictures over black and white were not rendered"), std::nullopt};
    const std::array<Named, 3> all = errors_over(*pair.more.reference_over, *pair.more.test_over);
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
    return {
        .id = "over_backgrounds",
        .name = "Over other backgrounds",
        .summary =
            "Differences of the float pictures rendered over black, over white and over a checker of 8 px, so that a "
            "wrong alpha is visible whatever the background of the comparison is. Null with a reason if a value is not "
            "finite.",
        .source = "Porter, Duff, Compositing Digital Images, SIGGRAPH 1984: a pixel over a background B is C + T B",
        .formula = "the greatest √(Σ(r − t)² / n) of the float values over black, white and a checker",
        .good_for = "a wrong alpha, whatever the background of the comparison is",
        .place = 57,
        .fields =
            {{.name = "worst",
              .kind = MetricField::Kind::text,
              .range = "black, white or checker",
              .summary =
                  "The background with the greatest error, the first if several are equal; null if nothing differs",
              .null_is_identical = true},
             {.name = "rmse",
              .range = "0..",
              .summary = "Root mean square error over the worst background",
              .column = {.head = "Worst background", .better = Better::lower, .note = "worst"}},
             {.name = "max_abs",
              .range = "0..",
              .summary = "Greatest absolute difference of a channel over any of the backgrounds"},
             {.name = "black", .range = "0..", .summary = "Root mean square error over black"},
             {.name = "white", .range = "0..", .summary = "Root mean square error over white"},
             {.name = "checker", .range = "0..", .summary = "Root mean square error over the checker"}},
        .compute = compute_over_backgrounds};
}

}  // namespace sheer
