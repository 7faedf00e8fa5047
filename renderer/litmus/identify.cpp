#include "renderer/litmus/identify.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sheer::litmus {

namespace {

/// Of pictures in 8 bits that were blended in 8 bits, each layer of which rounds.
constexpr double rounding = 1.2 / 255;
/// So that one pixel that is quite different, such as by overflow, does not hide that all others fit.
constexpr double most_of_one_pixel = 100;
/// Pictures fit if they are off by no more than this, in all and in each scene: 1.7 and 4.8 levels without chance. 64
/// layers that are blended in 8 bits may be off by four.
constexpr double most_excess = 2, most_excess_of_scene = 16;
/// The mean of many random pixels is close to what is expected: the mean square of how far, in standard deviations.
constexpr double most_bias = 4;
constexpr double same_within = 3.0 / 255, same_variance_ratio = 1.5;

std::vector<double> key_of(const Stack& stack, const Stack& by_middles) {
    std::vector<double> key(stack.below.begin(), stack.below.end());
    for (std::size_t i = 0; i < stack.fragments.size(); ++i) {
        const Fragment& fragment = stack.fragments[i];
        key.insert(key.end(), {fragment.depth, by_middles.fragments[i].depth, fragment.alpha});
        key.insert(key.end(), fragment.color.begin(), fragment.color.end());
    }
    return key;
}

std::vector<Drawing> every_drawing() {
    std::vector<Drawing> drawings;
    for (const FormulaInfo& formula : all_formulas())
        for (const nlohmann::json& parameters : formula.variants)
            for (const Order order : {Order::as_given, Order::far_to_near, Order::near_to_far}) {
                if (order != Order::as_given && !formula.depends_on_order) continue;
                for (const Colors colors : {Colors::straight, Colors::premultiplied, Colors::twice}) {
                    if (colors == Colors::premultiplied && !formula.weighs_by_alpha) continue;
                    for (const Blending blending : {Blending::encoded, Blending::linear, Blending::linear_kept}) {
                        // What a sample shows is not blended.
                        if (blending != Blending::encoded && formula.variance != nullptr) continue;
                        drawings.push_back({&formula, parameters, order, colors, blending});
                    }
                }
            }
    return drawings;
}

/// A sum does not fit into 16 bits. Devices make infinity of it, or the greatest number, so anything may be seen.
bool overflows(const Formula& formula, Stack stack) {
    if (!stack.sums_in_16_bits) return false;
    const Color in_16_bits = formula(stack);
    stack.sums_in_16_bits = false;
    return formula(stack) != in_16_bits;
}

constexpr double any_variance = 1;
constexpr Color anything = {any_variance, any_variance, any_variance};

/// Of pixels with the same contents, in one channel.
struct SumOfEqualPixels {
    double off = 0, count = 0;
};

bool are_close(const Color& a, const Color& b) {
    for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(a[i] - b[i]) > same_within) return false;
    return true;
}

bool vary_equally(const Color& a, const Color& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double more = std::max(a[i], b[i]), less = std::min(a[i], b[i]);
        if (more > rounding * rounding && more > same_variance_ratio * less) return false;
    }
    return true;
}

}  // namespace

Identifier::Identifier() : m_drawings(every_drawing()) {
    for (const LitmusScene& scene : all_litmus_scenes()) m_scenes.push_back(known(scene));
    for (const Drawing& drawing : m_drawings) {
        const Formula mean = drawing.formula->make(drawing.parameters);
        const Formula variance =
            drawing.formula->variance == nullptr ? nullptr : drawing.formula->variance(drawing.parameters);
        Predictions predictions;
        for (const KnownScene& scene : m_scenes) predictions.push_back(predict(scene, drawing, mean, variance));
        m_predictions.push_back(std::move(predictions));
    }
}

Identifier::KnownScene Identifier::known(const LitmusScene& scene) {
    const Compositor truth = scene.truth(), sorted = scene.as_sorted();
    KnownScene result{scene.id, {}, {}, {}};
    std::map<std::vector<double>, std::size_t> places;
    for (int y = 0; y < litmus_size_px; ++y)
        for (int x = 0; x < litmus_size_px; ++x) {
            const Stack stack = truth.stack(x, y), by_middles = sorted.stack(x, y);
            const auto [place, is_new] = places.try_emplace(key_of(stack, by_middles), result.stacks.size());
            result.stack_of_pixel.push_back(place->second);
            if (!is_new) continue;
            result.stacks.push_back(stack);
            result.by_middles.push_back(by_middles);
        }
    return result;
}

Identifier::Prediction Identifier::predict(const KnownScene& scene, const Drawing& drawing, const Formula& mean,
                                           const Formula& variance) {
    Prediction prediction;
    for (std::size_t i = 0; i < scene.stacks.size(); ++i) {
        const Stack stack = submitted(scene.stacks[i], scene.by_middles[i], drawing);
        const Color result = mean(stack);
        prediction.means.push_back(as_shown(result, drawing.blending));
        if (overflows(mean, stack)) {
            prediction.variances.push_back(anything);
        } else {
            prediction.variances.push_back(variance == nullptr ? Color{} : variance(stack));
        }
    }
    return prediction;
}

Pixels Identifier::draw(const LitmusScene& scene, const Drawing& drawing) {
    const KnownScene pixels = known(scene);
    const Prediction prediction = predict(pixels, drawing, drawing.formula->make(drawing.parameters), nullptr);
    Pixels picture;
    for (const std::size_t stack : pixels.stack_of_pixel) picture.push_back(prediction.means[stack]);
    return picture;
}

Fit Identifier::fit(const Predictions& predictions, const std::map<std::string, Pixels>& pictures) const {
    Fit fit;
    double squares = 0, excess = 0, count = 0, bias = 0, random_sums = 0;
    for (std::size_t scene = 0; scene < m_scenes.size(); ++scene) {
        const auto picture = pictures.find(m_scenes[scene].id);
        if (picture == pictures.end()) continue;
        const Prediction& prediction = predictions[scene];
        double of_scene = 0;
        std::vector<std::array<SumOfEqualPixels, 3>> sums(prediction.means.size());
        for (std::size_t pixel = 0; pixel < picture->second.size(); ++pixel) {
            const std::size_t stack = m_scenes[scene].stack_of_pixel[pixel];
            for (std::size_t i = 0; i < 3; ++i) {
                const double off = picture->second[pixel][i] - prediction.means[stack][i];
                const double expected = rounding * rounding + prediction.variances[stack][i];
                const double relative = std::min(off * off / expected, most_of_one_pixel);
                squares += off * off;
                sums[stack][i].off += off;
                ++sums[stack][i].count;
                of_scene += relative;
                fit.likelihood -= (relative + std::log(expected)) / 2;
                fit.greatest_levels = std::max(fit.greatest_levels, 255 * std::abs(off));
            }
        }
        for (std::size_t stack = 0; stack < sums.size(); ++stack)
            for (std::size_t i = 0; i < 3; ++i) {
                const double variance = prediction.variances[stack][i];
                if (variance == 0 || variance >= any_variance) continue;
                const auto& [off, number] = sums[stack][i];
                bias += std::min(off * off / (number * (rounding * rounding + variance)), most_of_one_pixel);
                ++random_sums;
            }
        const double values = 3 * static_cast<double>(picture->second.size());
        count += values;
        excess += of_scene;
        if (fit.worst_scene.empty() || of_scene / values > fit.worst_excess) {
            fit.worst_scene = m_scenes[scene].id;
            fit.worst_excess = of_scene / values;
        }
    }
    fit.rms_levels = 255 * std::sqrt(squares / count);
    fit.excess = excess / count;
    fit.bias = random_sums == 0 ? 0 : bias / random_sums;
    return fit;
}

bool Identifier::same(std::size_t a, std::size_t b, const std::map<std::string, Pixels>& pictures) const {
    for (std::size_t scene = 0; scene < m_scenes.size(); ++scene) {
        if (!pictures.contains(m_scenes[scene].id)) continue;
        const Prediction &of_a = m_predictions[a][scene], &of_b = m_predictions[b][scene];
        for (std::size_t i = 0; i < of_a.means.size(); ++i)
            if (!are_close(of_a.means[i], of_b.means[i]) || !vary_equally(of_a.variances[i], of_b.variances[i]))
                return false;
    }
    return true;
}

Identification Identifier::identify(const std::map<std::string, Pixels>& pictures) const {
    if (std::ranges::none_of(m_scenes, [&](const KnownScene& scene) { return pictures.contains(scene.id); }))
        throw std::invalid_argument("there is no picture of a litmus scene");
    std::vector<Fit> fits;
    for (const Predictions& predictions : m_predictions) fits.push_back(fit(predictions, pictures));
    std::vector<std::size_t> places(fits.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    std::ranges::stable_sort(places, std::greater(), [&](std::size_t i) { return fits[i].likelihood; });

    Identification result;
    result.fit = fits[places.front()];
    result.found = result.fit.excess <= most_excess && result.fit.worst_excess <= most_excess_of_scene &&
                   result.fit.bias <= most_bias;
    bool has_next = false;
    for (const std::size_t place : places) {
        if (same(places.front(), place, pictures)) {
            result.drawings.push_back(m_drawings[place]);
        } else if (!has_next) {
            has_next = true;
            result.next = m_drawings[place];
            result.next_fit = fits[place];
        }
    }
    return result;
}

}  // namespace sheer::litmus
