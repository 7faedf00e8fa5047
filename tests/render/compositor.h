#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

namespace sheer::test {

/// The answer for a `layers` scene, worked out on the CPU in double precision from the spec alone: which layers cover
/// the middle of each pixel, what opaque ones hide, and the over operator from the background forward.
class Compositor {
  public:
    using Color = std::array<double, 3>;
    struct Fragment {
        float depth;
        double alpha;
        Color color;
        std::size_t submitted = 0;  ///< place among the transparent layers
    };
    /// What a pixel holds: the opaque picture, and the transparent fragments that it does not hide, as submitted.
    struct Stack {
        Color below;
        std::vector<Fragment> fragments;
    };

    /// `black` is what is left of everything where no transmittance is; `alpha_test` is at the reference 0.5.
    enum class Order {
        by_depth,
        by_submission,
        black,
        alpha_test,
        meshkin_simple,
        meshkin_full,
        ssam,
        ssam_and_two_after,
        alpha_to_coverage
    };

    Compositor(const nlohmann::json& scene, int size_px, Color background)
        : m_size_px(size_px), m_background(background) {
        for (const auto& layer : scene.at("layers"))
            m_layers.push_back({layer.at("rect").get<std::array<double, 4>>(), layer.at("depth").get<float>(),
                                layer.at("color").get<Color>(), layer.at("alpha").get<double>(),
                                layer.at("opaque").get<bool>()});
    }

    Stack stack(int x, int y) const {
        Stack stack{m_background, {}};
        double opaque_depth = 2;
        for (const Layer& layer : m_layers) {
            // Of opaque layers at one depth the later submitted wins.
            if (layer.opaque && covers(layer, x, y) && layer.depth <= opaque_depth) {
                opaque_depth = layer.depth;
                stack.below = layer.color;
            }
        }
        std::size_t submitted = 0;
        for (const Layer& layer : m_layers) {
            if (layer.opaque) continue;
            if (covers(layer, x, y) && layer.depth <= opaque_depth)
                stack.fragments.push_back({layer.depth, layer.alpha, layer.color, submitted});
            ++submitted;
        }
        return stack;
    }

    Color pixel(int x, int y, Order order) const {
        Stack seen = stack(x, y);
        switch (order) {
            case Order::black:
                return {0, 0, 0};
            case Order::by_depth:
                std::ranges::stable_sort(seen.fragments, std::greater(), &Fragment::depth);
                return over(seen);
            case Order::by_submission:
                return over(seen);
            case Order::alpha_test:
                return nearest(seen, 0.5, seen.below);
            case Order::meshkin_simple:
                return meshkin(seen, false);
            case Order::meshkin_full:
                return meshkin(seen, true);
            case Order::ssam:
                return ssam(seen);
            case Order::ssam_and_two_after:
                return ssam_and_after(seen, 2);
            case Order::alpha_to_coverage:
                return alpha_to_coverage(seen, 4);
        }
        return {};
    }

    /// The over operator, from the first fragment to the last.
    static Color over(const Stack& stack) {
        Color color = stack.below;
        for (const Fragment& fragment : stack.fragments) color = mix(color, fragment.color, fragment.alpha);
        return color;
    }

    /// The nearest fragment of at least this alpha; of equal depths the later submitted.
    static Color nearest(const Stack& stack, double least_alpha, const Color& otherwise) {
        float nearest_depth = 2;
        Color color = otherwise;
        for (const Fragment& fragment : stack.fragments) {
            if (fragment.alpha < least_alpha || fragment.depth > nearest_depth) continue;
            nearest_depth = fragment.depth;
            color = fragment.color;
        }
        return color;
    }

    /// Meshkin's slides 20 and 34; where there is nothing to sum, what is below.
    static Color meshkin(const Stack& stack, bool full) {
        double alphas = 0, reciprocals = 0, product = 1;
        Color colors = {};
        for (const Fragment& fragment : stack.fragments) {
            if (fragment.alpha == 0) continue;
            alphas += fragment.alpha;
            reciprocals += 1 / fragment.alpha;
            product *= fragment.alpha;
            for (std::size_t i = 0; i < 3; ++i) colors[i] += fragment.alpha * fragment.color[i];
        }
        if (alphas == 0) return stack.below;
        Color color;
        for (std::size_t i = 0; i < 3; ++i) {
            const double d = stack.below[i];
            color[i] = d + colors[i] - d * alphas;
            if (full) color[i] += d * product - d * reciprocals * product;
            color[i] = std::clamp(color[i], 0.0, 1.0);
        }
        return color;
    }

    /// Hathaway's Listing 3.2 with the defaults: 85 % additive, squared, colour from 64/255 up, else black.
    static Color ssam(const Stack& stack) {
        double greatest = 0, sum = 0;
        for (const Fragment& fragment : stack.fragments) {
            greatest = std::max(greatest, fragment.alpha);
            sum += fragment.alpha;
        }
        const double mask = 0.15 * greatest + 0.85 * std::min(sum, 1.0);
        return mix(stack.below, nearest(stack, 64.0 / 255, {0, 0, 0}), mask * mask);
    }

    /// SSAM of all but the last `count` layers as submitted; these over it where they are not behind its foliage: the
    /// nearest fragment from 64/255 up.
    Color ssam_and_after(const Stack& stack, std::size_t count) const {
        const auto transparent =
            static_cast<std::size_t>(std::ranges::count_if(m_layers, [](const Layer& layer) { return !layer.opaque; }));
        Stack foliage{stack.below, {}}, after;
        float foliage_depth = 2;
        for (const Fragment& fragment : stack.fragments)
            if (fragment.submitted + count < transparent) {
                foliage.fragments.push_back(fragment);
                if (fragment.alpha >= 64.0 / 255) foliage_depth = std::min(foliage_depth, fragment.depth);
            }
        for (const Fragment& fragment : stack.fragments)
            if (fragment.submitted + count >= transparent && fragment.depth <= foliage_depth)
                after.fragments.push_back(fragment);
        std::ranges::stable_sort(after.fragments, std::greater(), &Fragment::depth);
        after.below = ssam(foliage);
        return over(after);
    }

    /// Of n samples a fragment covers those i with alpha > i / n, which is llvmpipe's rule; each shows its nearest one.
    static Color alpha_to_coverage(const Stack& stack, int samples) {
        Color mean = {};
        for (int sample = 0; sample < samples; ++sample) {
            Stack covering{stack.below, {}};
            for (const Fragment& fragment : stack.fragments)
                if (fragment.alpha * samples > sample) covering.fragments.push_back(fragment);
            const Color seen = nearest(covering, 0, stack.below);
            for (std::size_t i = 0; i < 3; ++i) mean[i] += seen[i] / samples;
        }
        return mean;
    }

    static Color mix(const Color& a, const Color& b, double weight_of_b) {
        Color mixed;
        for (std::size_t i = 0; i < 3; ++i) mixed[i] = (1 - weight_of_b) * a[i] + weight_of_b * b[i];
        return mixed;
    }

  private:
    struct Layer {
        std::array<double, 4> rect;
        float depth;
        Color color;
        double alpha;
        bool opaque;
    };

    bool covers(const Layer& layer, int x, int y) const {
        const auto& rect = layer.rect;
        const double px = (x + 0.5) / m_size_px, py = (y + 0.5) / m_size_px;
        return px > rect[0] && px < rect[2] && py > rect[1] && py < rect[3];
    }

    std::vector<Layer> m_layers;
    int m_size_px;
    Color m_background;
};

}  // namespace sheer::test
