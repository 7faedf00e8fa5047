// The volume scene compared with a ray through slices, worked out by hand or in double precision on the CPU.
#include "renderer/scene/volume.h"

#include "tests/render/render_test.h"

namespace sheer::test::volume_test {

namespace {

constexpr int size_px = 33;  // so that one pixel looks straight ahead
constexpr int middle_px = size_px / 2;
const std::array<double, 3> background{0.2, 0.4, 0.6};

class HandVolume : public NoAssets {
  public:
    explicit HandVolume(Volume volume) : m_volume(std::move(volume)) {}
    Volume volume(const std::string&, const VolumeOptions&) override { return m_volume; }

  private:
    Volume m_volume;
};

Volume volume_of(const glm::ivec3& size, std::vector<std::uint8_t> bytes) {
    return {.size = size, .spacing = 1.0 / glm::dvec3(size), .bytes = std::move(bytes), .floats = {}};
}

/// The box is the cube of side 2 around (0, 1.5, 0), seen from the distance 5 along z under a right angle.
nlohmann::json scene_with(int slices, double density, const nlohmann::json& transfer) {
    return {{"type", "volume"},
            {"slices", slices},
            {"density", density},
            {"transfer", transfer},
            {"light", false},
            {"frame", false},
            {"volume", {{"data", "by hand"}}},
            {"camera", {{"eye", {0, 1.5, 5}}, {"target", {0, 1.5, 0}}, {"fov_y_deg", 90}}}};
}

nlohmann::json point(double value, const std::array<double, 3>& color, double alpha) {
    return {{"value", value}, {"color", color}, {"alpha", alpha}};
}

Image picture_of(const nlohmann::json& scene, const Volume& volume, const std::string& method = "b2f") {
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene, {method}, size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f, std::make_unique<HandVolume>(volume));
    return stage.picture(spec.methods[0]);
}

/// Every slice adds the same opacity a, so n of them let (1 - a)^n through. The opacity of the whole does not depend on
/// the number of slices: the transfer function's alpha is that of 1/256 of the volume.
TEST(VolumeOpacity, OfAConstantVolumeIsThatOfItsDepthWhateverTheSlices) {
    const std::array<double, 3> color{0.9, 0.5, 0.1};
    const double alpha = 0.03, density = 0.5;
    const double left = std::pow(1 - alpha, density * 256);
    for (const int slices : {1, 7, 64, 300}) {
        const Image image = picture_of(scene_with(slices, density, nlohmann::json::array({point(0.5, color, alpha)})),
                                       volume_of({1, 1, 1}, {128}));
        for (std::size_t channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(image.pixel(middle_px, middle_px)[channel],
                        color[channel] * (1 - left) + background[channel] * left, 2e-5)
                << slices;
    }
}

/// Slices are squares of side 2, at distances of 4 + (i + 0.5) 2/n; how many cover a pixel follows from perspective.
TEST(VolumeSlices, CoverWhatTheCubeCovers) {
    constexpr int slices = 7;
    const double alpha = 0.2;
    const Image image =
        picture_of(scene_with(slices, slices / 256.0, nlohmann::json::array({point(0.5, {1, 1, 1}, alpha)})),
                   volume_of({1, 1, 1}, {128}));
    std::array<bool, slices + 1> seen{};
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            // With a right angle, half the picture is as wide as it is far away.
            const double out = std::max(std::abs(x - middle_px), std::abs(y - middle_px)) * 2.0 / size_px;
            int covered = 0;
            for (int i = 0; i < slices; ++i) covered += out < 1 / (4 + (i + 0.5) * 2 / slices);
            seen[static_cast<std::size_t>(covered)] = true;
            const double left = std::pow(1 - alpha, covered);
            for (std::size_t channel = 0; channel < 3; ++channel)
                ASSERT_NEAR(image.pixel(x, y)[channel], 1 - left + background[channel] * left, 1e-5) << x << ' ' << y;
        }
    EXPECT_GE(std::ranges::count(seen, true), 3) << "the picture is too coarse to see the slices' sizes";
}

double mix(double a, double b, double weight_of_b) {
    return a + (b - a) * weight_of_b;
}

/// Linear between the middles of voxels, constant beyond the outer ones.
double value_along(const std::vector<double>& voxels, double at) {
    const double position =
        std::clamp(at * static_cast<double>(voxels.size()) - 0.5, 0.0, static_cast<double>(voxels.size()) - 1);
    const auto first = std::min(static_cast<std::size_t>(position), voxels.size() - 2);
    return mix(voxels[first], voxels[first + 1], position - static_cast<double>(first));
}

/// The last voxel along z is nearest; with the value, red turns into blue and clear into opaque.
TEST(VolumeRay, IsThatOfTheCpu) {
    constexpr int slices = 40;
    const double density = 1.5;
    Volume bytes = volume_of({1, 1, 4}, {0, 255, 51, 204});
    Volume floats = bytes;
    floats.bytes.clear();
    floats.floats = {0, 1, 0.2f, 0.8f};
    const auto scene = scene_with(slices, density, {point(0.1, {1, 0, 0}, 0), point(0.9, {0, 0.25, 1}, 0.1)});
    std::array<double, 3> expected = background;
    for (int i = 0; i < slices; ++i) {
        const double value = value_along({0, 1, 0.2, 0.8}, (i + 0.5) / slices);
        const double along = std::clamp((value - 0.1) / 0.8, 0.0, 1.0);
        const double alpha = 1 - std::pow(1 - 0.1 * along, density * 256 / slices);
        const std::array<double, 3> color{1 - along, 0.25 * along, along};
        for (std::size_t channel = 0; channel < 3; ++channel)
            expected[channel] = mix(expected[channel], color[channel], alpha);
    }
    for (const Volume& volume : {bytes, floats})
        for (const char* method : {"b2f", "f2b", "exact"}) {
            const Image image = picture_of(scene, volume, method);
            for (std::size_t channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(image.pixel(middle_px, middle_px)[channel], expected[channel], 2e-4) << method;
        }
}

/// Voxels run to the right, up and to the front: of two, the one of value 1 is opaque.
TEST(VolumeAxes, AreThoseOfTheScene) {
    const nlohmann::json transfer = {point(0.45, {1, 1, 1}, 0), point(0.55, {1, 1, 1}, 1)};
    const Image along_x = picture_of(scene_with(16, 1, transfer), volume_of({2, 1, 1}, {0, 255}));
    EXPECT_NEAR(along_x.pixel(middle_px - 2, middle_px)[0], background[0], 1e-6);
    EXPECT_NEAR(along_x.pixel(middle_px + 2, middle_px)[0], 1, 1e-6);
    const Image along_y = picture_of(scene_with(16, 1, transfer), volume_of({1, 2, 1}, {0, 255}));
    EXPECT_NEAR(along_y.pixel(middle_px, middle_px - 2)[0], 1, 1e-6);
    EXPECT_NEAR(along_y.pixel(middle_px, middle_px + 2)[0], background[0], 1e-6);
}

/// A volume of 2 x 1 x 4 cubic voxels has a box whose other sides are half and a quarter of its length.
TEST(VolumeSpacing, ShapesTheBox) {
    Volume volume = volume_of({2, 2, 2}, std::vector<std::uint8_t>(8, 255));
    volume.spacing = {2, 1, 4};
    const Image image = picture_of(scene_with(32, 1, nlohmann::json::array({point(1, {1, 1, 1}, 1)})), volume);
    // The front is 4 away, and 0.5 and 0.25 to either side: an eighth and a sixteenth of half the picture.
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            const bool within =
                std::abs(x - middle_px) * 2.0 / size_px < 0.125 && std::abs(y - middle_px) * 2.0 / size_px < 0.0625;
            EXPECT_NEAR(image.pixel(x, y)[0], within ? 1 : background[0], 1e-6) << x << ' ' << y;
        }
}

/// Where values do not change there is no boundary to light: the shader then gives 0.8 of the color.
TEST(VolumeLight, ChangesColorsNotOpacity) {
    nlohmann::json scene = scene_with(16, 1, nlohmann::json::array({point(0.5, {0.5, 0.5, 0.5}, 1)}));
    scene["light"] = true;
    EXPECT_NEAR(picture_of(scene, volume_of({1, 1, 1}, {128})).pixel(middle_px, middle_px)[0], 0.4, 1e-6);
}

/// A step along x faces sideways, one along y faces up: the sun is to the left and above, so the left and the upper
/// side are the brighter ones of each pair.
TEST(VolumeLight, FallsFromTheUpperLeft) {
    nlohmann::json scene = scene_with(64, 1, {point(0.3, {0.5, 0.5, 0.5}, 0), point(0.6, {0.5, 0.5, 0.5}, 1)});
    scene["light"] = true;
    scene["camera"] = {{"eye", {0, 1.5, 5}}, {"target", {0, 1.5, 0}}, {"fov_y_deg", 30}};
    std::vector<std::uint8_t> ball;
    constexpr int n = 24;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const glm::dvec3 at = (glm::dvec3(x, y, z) + 0.5) * (2.0 / n) - 1.0;
                ball.push_back(
                    static_cast<std::uint8_t>(255 * std::clamp(0.5 + 4 * (0.7 - glm::length(at)), 0.0, 1.0)));
            }
    const Image image = picture_of(scene, volume_of({n, n, n}, ball));
    const auto at = [&](int right, int down) { return image.pixel(middle_px + right, middle_px + down)[0]; };
    EXPECT_GT(at(-5, 0), at(5, 0) + 0.05f);
    EXPECT_GT(at(0, -5), at(0, 5) + 0.05f);
}

/// Seen from above, the plinth's top reaches 0.05 into the box: slices above it cover it, those below are hidden.
TEST(VolumeOpaque, IsVeiledByWhatIsInFrontOfItAlone) {
    constexpr int slices = 50;
    const std::array<double, 3> color{0.1, 0.9, 0.2};
    const double alpha = 0.04;
    nlohmann::json scene = scene_with(slices, slices / 256.0, nlohmann::json::array({point(0.5, color, alpha)}));
    scene["frame"] = true;
    scene["camera"] = {{"eye", {0, 8, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, -1}}, {"fov_y_deg", 20}};
    nlohmann::json clear = scene;
    clear["transfer"] = nlohmann::json::array({point(0.5, color, 0)});
    const Volume volume = volume_of({1, 1, 1}, {128});
    int above = 0;
    for (int i = 0; i < slices; ++i) above += 0.5 + (i + 0.5) * 2 / slices > 0.5 + 0.05;
    ASSERT_LT(above, slices);
    for (const char* method : {"b2f", "f2b", "exact", "depth_peeling"}) {
        const Image veiled = picture_of(scene, volume, method), bare = picture_of(clear, volume, method);
        EXPECT_GT(std::abs(bare.pixel(middle_px, middle_px)[0] - background[0]), 0.02) << "there is no plinth";
        const double left = std::pow(1 - alpha, above);
        for (std::size_t channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(veiled.pixel(middle_px, middle_px)[channel],
                        color[channel] * (1 - left) + bare.pixel(middle_px, middle_px)[channel] * left, 2e-5)
                << method;
    }
}

/// Slices do not intersect: drawing them in order is as good as sorting fragments, from any side and from within.
TEST(VolumeSlices, SortedAreExact) {
    const auto context = make_context("egl");
    for (const std::array<double, 3>& eye : {std::array{-2.5, 2.5, 4.0}, {3.0, -0.5, -2.0}, {0.2, 1.7, 0.3}}) {
        nlohmann::json scene = {{"type", "volume"}, {"slices", 60}, {"volume", {{"resolution", 32}}}};
        scene["camera"] = {{"eye", eye}, {"target", {0, 1.4, 0}}, {"fov_y_deg", 40}};
        const Spec spec = make_spec(scene, {{{"id", "exact"}, {"form", "lists"}}, "f2b", "b2f"}, size_px, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const Image lists = stage.picture(spec.methods[0]);
        EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[1])), 2e-5);
        EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[2])), 2e-5);
    }
}

/// The general shadings on slices: they need no volume.
TEST(VolumeShadings, AllDraw) {
    const auto context = make_context("egl");
    for (const std::string shading : {"constant", "1-texture", "4-textures", "4-textures-math", "4x4-textures",
                                      "4x4-textures-math", "transfer-function"}) {
        const nlohmann::json scene = {{"type", "volume"},
                                      {"slices", 20},
                                      {"volume", {{"resolution", 32}}},
                                      {"shading", shading},
                                      {"texture", {{"size", 32}}}};
        const Spec spec = make_spec(scene, {"f2b", "exact"}, size_px, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const Image image = stage.picture(spec.methods[0]);
        EXPECT_LE(greatest_difference(image, stage.picture(spec.methods[1])), 2e-5) << shading;
        int drawn = 0;
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x) drawn += std::abs(image.pixel(x, y)[2] - background[2]) > 0.02;
        EXPECT_GT(drawn, size_px * size_px / 10) << shading;
    }
}

}  // namespace

}  // namespace sheer::test::volume_test
