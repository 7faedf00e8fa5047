// The cap, the guess from the previous frame and its convergence, compared with values worked out by hand.
#include <cmath>

#include "renderer/compare/compare.h"
#include "renderer/core/random.h"
#include "renderer/methods/shared/stencil_cap.h"
#include "tests/render/sample_count.h"

namespace sheer::test::stencil_cap_test {

namespace {

constexpr int size_px = 16;
constexpr int pixels = size_px * size_px;

nlohmann::json cap(int layers, int frames, double min_alpha = 0, bool zcull = false) {
    return {{"id", "stencil_cap"}, {"layers", layers}, {"frames", frames}, {"min_alpha", min_alpha}, {"zcull", zcull}};
}

/// The background of `make_spec`.
constexpr std::array background = {0.2, 0.4, 0.6};

class StencilCapTest : public testing::Test {
  protected:
    Image picture(const nlohmann::json& scene, const nlohmann::json& method) {
        const Spec spec = make_spec(scene, nlohmann::json::array({method}), size_px, "rgba32f");
        return Stage(*m_context, spec, PixelFormat::rgba32f).picture(spec.methods[0]);
    }

    std::int64_t samples(const nlohmann::json& scene, const nlohmann::json& method) {
        const Spec spec = make_spec(scene, nlohmann::json::array({method}), size_px);
        Stage stage(*m_context, spec, PixelFormat::rgba8);
        const auto made = stage.make(spec.methods[0]);
        return samples_of_frame(*m_context, stage, *made);
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

/// Rectangles on a grid of 4 pixels, in random order, some of them opaque objects.
nlohmann::json random_layers(std::uint64_t seed) {
    Random random(seed);
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 30; ++i) {
        const double x = 0.25 * static_cast<double>(random.below(3)), y = 0.25 * static_cast<double>(random.below(3));
        layers.push_back({{"rect", {x, y, x + 0.25 * static_cast<double>(1 + random.below(3)), y + 0.5}},
                          {"depth", random.between(0.05, 0.95)},
                          {"color", {random.unit(), random.unit(), random.unit()}},
                          {"alpha", i % 7 == 3 ? 0.0 : 0.5 * random.unit()},
                          {"opaque", i % 15 == 9}});
    }
    return layers_scene(layers);
}

/// The nearest `cap` layers of a pixel that no opaque object hides, over the nearest such object or the background.
std::array<double, 3> capped_pixel(const nlohmann::json& scene, int x, int y, int cap) {
    std::vector<nlohmann::json> hit;
    for (const auto& layer : scene.at("layers")) {
        const double px = (x + 0.5) / size_px, py = (y + 0.5) / size_px;
        const auto rect = layer.at("rect").get<std::array<double, 4>>();
        if (px > rect[0] && px < rect[2] && py > rect[1] && py < rect[3]) hit.push_back(layer);
    }
    std::ranges::sort(hit, {}, [](const auto& layer) { return layer.at("depth").template get<double>(); });
    std::array<double, 3> color = {0, 0, 0};
    double transmittance = 1;
    int drawn = 0;
    std::array<double, 3> behind = background;
    for (const auto& layer : hit) {
        const auto own = layer.at("color").get<std::array<double, 3>>();
        if (layer.at("opaque")) {
            behind = own;
            break;
        }
        if (drawn++ >= cap) continue;
        for (std::size_t i = 0; i < 3; ++i) color[i] += transmittance * layer.at("alpha").get<double>() * own[i];
        transmittance *= 1 - layer.at("alpha").get<double>();
    }
    for (std::size_t i = 0; i < 3; ++i) color[i] += transmittance * behind[i];
    return color;
}

/// The first frame guesses nothing. On a grid of 4 pixels the coarse depth is correct, so zcull changes nothing.
TEST_F(StencilCapTest, FirstFrameIsTheNearestLayers) {
    for (const std::uint64_t seed : {1, 2, 3})
        for (const int layers : {1, 3, 30})
            for (const bool zcull : {false, true}) {
                const nlohmann::json scene = random_layers(seed);
                const Image image = picture(scene, cap(layers, 1, 0, zcull));
                double greatest = 0;
                for (int y = 0; y < size_px; ++y)
                    for (int x = 0; x < size_px; ++x)
                        for (int i = 0; i < 3; ++i)
                            greatest = std::max(greatest, std::abs(capped_pixel(scene, x, y, layers)[i] -
                                                                   double{image.pixel(x, y)[i]}));
                EXPECT_LE(greatest, 1e-5) << seed << ' ' << layers << ' ' << zcull;
            }
}

nlohmann::json half_white_layers(int count) {
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < count; ++i) layers.push_back(full_layer(0.1 + 0.05 * i, {1, 0.5, 0}, 0.5));
    return layers_scene(layers);
}

/// Depth copy, 3 of 10 layers, fill and composite. With zcull also one depth for each of the 4 x 4 coarse pixels, two
/// triangles for each, which cover the picture, and all layers once more for counting.
TEST_F(StencilCapTest, DrawsAsManyLayersAsTheCap) {
    EXPECT_EQ(samples(half_white_layers(10), cap(3, 2)), pixels * (1 + 3 + 1 + 1));
    EXPECT_EQ(samples(half_white_layers(10), cap(3, 1)), pixels * (1 + 3 + 1));
    EXPECT_EQ(samples(half_white_layers(2), cap(3, 2)), pixels * (1 + 2 + 1));
    EXPECT_EQ(samples(half_white_layers(10), cap(3, 2, 0, true)),
              pixels * (1 + 3 + 1 + 1) + pixels / 16 + pixels + pixels * 10);
    EXPECT_EQ(samples(half_white_layers(2), cap(3, 2, 0, true)), pixels * (1 + 2 + 1) + pixels * 2);
}

/// Uniform picture, two layers of alpha 0.5 let through: A = 0.75 c, T = 0.25. P(1) = A + T D, P(n) = A + T P(n - 1),
/// so P(n) = c (1 - T^n) + T^n D, which tends to c; the change shrinks by T per frame.
TEST_F(StencilCapTest, ConvergesAsComputed) {
    const std::array color = {1.0, 0.5, 0.0};
    for (const int frames : {1, 2, 3, 30}) {
        const Image image = picture(half_white_layers(6), cap(2, frames));
        const double left = std::pow(0.25, frames);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(image.pixel(7, 9)[i], color[i] * (1 - left) + left * background[i], 1e-6) << frames;
    }
    const Spec spec = make_spec(half_white_layers(6), nlohmann::json::array({cap(2, 6)}), size_px, "rgba32f");
    const Stage stage(*m_context, spec, PixelFormat::rgba32f);
    StencilCap method({*m_context, m_context->gl(), stage.scene(), stage.target()},
                      StencilCapParameters::table().read(spec.methods[0].parameters));
    gl::FrameTimer timer(*m_context);
    gl::FrameTimer::Frame frame = timer.frame(false);
    const std::vector<double> changes = method.change_per_frame(timer);
    frame.end();
    ASSERT_EQ(changes.size(), 5u);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(changes[i], 0.8 * 0.75 * std::pow(0.25, i + 1), 1e-6) << i;  // red: 1 - 0.2
}

TEST_F(StencilCapTest, TheRunHasTheChangePerFrame) {
    const Spec spec = make_spec(half_white_layers(6), nlohmann::json::array({"b2f", cap(2, 4)}), size_px, "rgba32f");
    NoAssets assets;
    nlohmann::json of_b2f, of_cap;
    compare(
        spec, *m_context, assets, [](double, const std::string&) {},
        [&](const sheer::Run& run) {
            of_b2f = run.results[0].findings;
            of_cap = run.results[1].findings;
        });
    EXPECT_EQ(of_b2f, nlohmann::json::object());
    ASSERT_EQ(of_cap["change_per_frame"].size(), 3u);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(of_cap["change_per_frame"][i].get<double>(), 0.8 * 0.75 * std::pow(0.25, i + 1), 1e-6) << i;
}

/// The cap hides a clear layer at the back. Black at 0.5 in front of white up to column 3 and of black from there: P(1)
/// is 0.5 and 0. At half the size the columns are 0.5, (0.5 + 0) / 2, 0, 0, ...; drawn at full size, between their
/// middles, they have the weights 3/4 and 1/4.
TEST_F(StencilCapTest, FillsWithTheHalvedPreviousFrame) {
    const nlohmann::json layers = {
        {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {0, 0, 0}}, {"alpha", 0.5}},
        full_layer(0.7, {0, 1, 1}, 0),
        {{"rect", {0, 0, 3.0 / size_px, 1}}, {"depth", 0.8}, {"color", {1, 1, 1}}, {"opaque", true}},
        {{"rect", {3.0 / size_px, 0, 1, 1}}, {"depth", 0.8}, {"color", {0, 0, 0}}, {"opaque", true}}};
    const Image first = picture(layers_scene(layers), cap(1, 1)), second = picture(layers_scene(layers), cap(1, 2));
    const std::array halved = {0.5, 0.4375, 0.3125, 0.1875, 0.0625, 0.0, 0.0};
    for (std::size_t x = 0; x < halved.size(); ++x) {
        EXPECT_NEAR(first.pixel(static_cast<int>(x), 5)[0], x < 3 ? 0.5 : 0.0, 1e-6) << x;
        EXPECT_NEAR(second.pixel(static_cast<int>(x), 5)[0], 0.5 * halved[x], 1e-6) << x;
    }
}

/// A pixel under the cap shows what is behind it, however many frames there are.
TEST_F(StencilCapTest, NothingIsGuessedUnderTheCap) {
    const Image image = picture(half_white_layers(2), cap(3, 5));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(image.pixel(4, 4)[i], 0.75 * (std::array{1.0, 0.5, 0.0}[i]) + 0.25 * background[i], 1e-6);
}

/// Nor if the cap is just reached and there is nothing more, whether the alpha test, the stencil alone or a separate
/// pass counts; nor if opaque geometry hides all that follows, or the alpha test drops it.
TEST_F(StencilCapTest, NothingIsGuessedWhereNothingIsHidden) {
    const nlohmann::json two = {full_layer(0.2, {1, 0.5, 0}, 0.5), full_layer(0.3, {1, 0.5, 0}, 0.5)};
    const auto with = [&](std::vector<nlohmann::json> more) {
        nlohmann::json layers = two;
        for (const nlohmann::json& layer : more) layers.push_back(layer);
        return layers_scene(layers);
    };
    const std::array color = {1.0, 0.5, 0.0}, wall = {0.1, 0.9, 0.3};
    for (const bool zcull : {false, true})
        for (const double min_alpha : {0.0, 0.1}) {
            const auto expect = [&](const nlohmann::json& scene, const std::array<double, 3>& behind,
                                    const char* what) {
                const Image image = picture(scene, cap(2, 6, min_alpha, zcull));
                for (int i = 0; i < 3; ++i)
                    EXPECT_NEAR(image.pixel(4, 4)[i], 0.75 * color[i] + 0.25 * behind[i], 1e-6)
                        << what << zcull << min_alpha << i;
            };
            expect(with({}), background, "just full");
            expect(with({full_layer(0.8, wall, 1, true)}), wall, "just full before a wall");
            expect(with({full_layer(0.5, wall, 1, true), full_layer(0.6, {1, 1, 1}, 0.5)}), wall, "hidden by the wall");
            if (min_alpha > 0) expect(with({full_layer(0.6, {1, 1, 1}, 0.05)}), background, "too faint");
            // With one more layer, the guess tends to the picture of the nearest two alone.
            const Image guessed = picture(with({full_layer(0.6, {1, 1, 1}, 0.5)}), cap(2, 30, min_alpha, zcull));
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(guessed.pixel(4, 4)[i], color[i], 1e-6) << zcull << min_alpha;
        }
}

TEST_F(StencilCapTest, AHigherCapThanTheStencilCountsIsRefused) {
    EXPECT_THROW(picture(half_white_layers(1), cap(255, 1)), SpecError);
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 254; ++i) layers.push_back(full_layer(0.1 + 0.001 * i, {1, 1, 1}, 0.01));
    const double left = std::pow(0.99, 254);
    for (const double min_alpha : {0.0, 0.005})
        EXPECT_NEAR(picture(layers_scene(layers), cap(254, 3, min_alpha)).pixel(3, 3)[0],
                    1 - left + left * background[0], 1e-5);
}

/// Two faint layers in front of two of alpha 0.5, with a cap of two: they use it up, unless the alpha test drops them.
TEST_F(StencilCapTest, FaintFragmentsUseUpNoLayer) {
    const nlohmann::json layers = {full_layer(0.1, {0, 0, 0}, 0.01), full_layer(0.2, {0, 0, 0}, 0.01),
                                   full_layer(0.3, {1, 1, 1}, 0.5), full_layer(0.4, {1, 1, 1}, 0.5)};
    for (const bool zcull : {false, true}) {
        const Image with = picture(layers_scene(layers), cap(2, 1, 0, zcull));
        const Image without = picture(layers_scene(layers), cap(2, 1, 0.02, zcull));
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(with.pixel(3, 3)[i], 0.99 * 0.99 * background[i], 1e-6);
            EXPECT_NEAR(without.pixel(3, 3)[i], 0.75 + 0.25 * background[i], 1e-6);
        }
    }
}

/// If the middle of a 4 x 4 block is full but one of its pixels is not, zcull loses what is behind in that pixel.
TEST_F(StencilCapTest, ZcullDecidesForWholeBlocks) {
    const nlohmann::json layers = {
        {{"rect", {1.0 / size_px, 0, 4.0 / size_px, 4.0 / size_px}}, {"depth", 0.3}, {"color", {1, 0, 0}}},
        full_layer(0.6, {0, 1, 0}, 0.5)};
    const Image fine = picture(layers_scene(layers), cap(1, 1)),
                coarse = picture(layers_scene(layers), cap(1, 1, 0, true));
    const std::array red = {1.0, 0.0, 0.0}, green = {0.0, 1.0, 0.0};
    for (int i = 0; i < 3; ++i) {
        for (const Image* image : {&fine, &coarse}) {
            EXPECT_NEAR(image->pixel(1, 1)[i], 0.5 * red[i] + 0.5 * background[i], 1e-6);
            EXPECT_NEAR(image->pixel(0, 4)[i], 0.5 * green[i] + 0.5 * background[i], 1e-6);
            EXPECT_NEAR(image->pixel(0, 15)[i], 0.5 * green[i] + 0.5 * background[i], 1e-6);
        }
        EXPECT_NEAR(fine.pixel(0, 1)[i], 0.5 * green[i] + 0.5 * background[i], 1e-6);
        EXPECT_NEAR(coarse.pixel(0, 1)[i], background[i], 1e-6);
    }
}

/// Rendering again gives the last frame again, and a second method starts from the beginning.
TEST_F(StencilCapTest, PictureIsThatOfTheLastFrame) {
    const Spec spec = make_spec(half_white_layers(6), nlohmann::json::array({cap(1, 3)}), size_px, "rgba32f");
    Stage stage(*m_context, spec, PixelFormat::rgba32f);
    const auto method = stage.make(spec.methods[0]);
    stage.frame(*method);
    const Image first = stage.target().read();
    EXPECT_NEAR(first.pixel(0, 0)[0], 1 - 0.8 / 8, 1e-6);
    for (int i = 0; i < 3; ++i) stage.frame(*method);
    EXPECT_EQ(greatest_difference(first, stage.target().read()), 0);
    EXPECT_EQ(greatest_difference(first, stage.picture(spec.methods[0])), 0);
}

TEST_F(StencilCapTest, SaysWhatItTakes) {
    const Spec spec = make_spec(half_white_layers(1), {cap(8, 1), cap(8, 1, 0, true)}, size_px);
    Stage stage(*m_context, spec, PixelFormat::rgba8);
    // 16 x 16 pixels: accumulation 1024, depth and stencil 2048, two frames of 1024 + 256; 4 x 4 coarse ones of 8, and
    // counts of 2.
    EXPECT_EQ(stage.make(spec.methods[0])->memory_bytes(), 1024 + 2048 + 2 * 1280);
    EXPECT_EQ(stage.make(spec.methods[1])->memory_bytes(), 1024 + 2048 + 2 * 1280 + 128 + 512);
}

}  // namespace

}  // namespace sheer::test::stencil_cap_test
