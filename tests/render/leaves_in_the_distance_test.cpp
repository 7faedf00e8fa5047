// What an alpha test leaves of foliage as it recedes, with plain mipmaps and with those that keep their coverage.
#include <cmath>

#include "tests/render/render_test.h"

namespace sheer::test::leaves_in_the_distance_test {

namespace {

using nlohmann::json;

constexpr int size_px = 128;

class Leaves : public testing::Test {
  protected:
    /// How much the leaves change of the background, over all pixels: their area, seen from so far away.
    double area(const json& method, double distance, double coverage_alpha) {
        const json scene = {{"type", "foliage"},
                            {"trees", 1},
                            {"planes_per_tree", 60},
                            {"camera", {{"eye", {0, 1.3, distance}}, {"target", {0, 1.3, 0}}}},
                            {"texture", {{"image", "leaf"}, {"size", 256}, {"coverage_alpha", coverage_alpha}}}};
        const Spec spec = make_spec(scene, json::array({method}), size_px, "rgba32f");
        NoAssets assets;
        Geometry geometry = build_geometry(spec.scene, spec.image, assets);
        const Image with = picture(spec, geometry);
        std::erase_if(geometry.primitives, [](const Primitive& primitive) { return !primitive.opaque; });
        const Image without = picture(spec, geometry);
        double sum = 0;
        for (std::size_t i = 0; i < with.rgba.size(); ++i) sum += std::abs(double{with.rgba[i]} - without.rgba[i]);
        return sum;
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");

  private:
    Image picture(const Spec& spec, const Geometry& geometry) {
        return Stage(*m_context, spec, spec.image.format, geometry).picture(spec.methods[0]);
    }
};

/// With a threshold over the mean alpha of the leaves, plain mipmaps lose them with the distance. What is left is
/// compared with blending, whose area is right.
TEST_F(Leaves, DissolveUnderAnAlphaTestUnlessMipmapsKeepTheirCoverage) {
    const json alpha_test = {{"id", "alpha_test"}, {"reference", 0.75}};
    for (const double distance : {4.0, 32.0}) {
        const double blended = area({{"id", "exact"}}, distance, 0);
        const double plain = area(alpha_test, distance, 0) / blended,
                     covered = area(alpha_test, distance, 0.75) / blended;
        EXPECT_NEAR(covered, 1, 0.1) << distance;
        if (distance < 10) {
            EXPECT_NEAR(plain, 1, 0.1);
        } else {
            EXPECT_LT(plain, 0.7);
        }
    }
}

}  // namespace

}  // namespace sheer::test::leaves_in_the_distance_test
