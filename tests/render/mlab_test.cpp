// How the picture of MLAB depends on the order of submission.
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::mlab_test {

namespace {

using nlohmann::json;

/// Full layers of alpha 0.6 in these colors, from near to far.
json layers_of(const std::vector<Color>& colors) {
    json layers = json::array();
    for (std::size_t i = 0; i < colors.size(); ++i)
        layers.push_back({{"rect", {0, 0, 1, 1}},
                          {"depth", 0.1 + 0.1 * static_cast<double>(i)},
                          {"color", colors[i]},
                          {"alpha", 0.6},
                          {"opaque", false}});
    return layers;
}

json in_order(const json& layers, const std::vector<std::size_t>& order) {
    json all = json::array();
    for (const std::size_t i : order) all.push_back(layers[i]);
    return {{"type", "layers"}, {"layers", all}};
}

class Mlab : public testing::Test {
  protected:
    void SetUp() override {
        if (!m_context->has_extension("GL_EXT_shader_framebuffer_fetch")) GTEST_SKIP() << "it needs framebuffer fetch";
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

/// With two nodes, 0, 1 and 3 leave the node 1 + 3; 2 comes later and is then behind both.
TEST_F(Mlab, DependsOnTheOrderBeyondItsNodes) {
    const json layers = layers_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    const json method = {{"id", "mlab"}, {"nodes", 2}};
    const std::vector<std::pair<std::vector<std::size_t>, bool>> orders = {
        {{0, 1, 2, 3}, true}, {{3, 2, 1, 0}, true},  {{0, 3, 2, 1}, true},
        {{2, 0, 3, 1}, true}, {{0, 1, 3, 2}, false}, {{1, 3, 0, 2}, false}};
    for (const auto& [order, is_exact] : orders) {
        const json scene = in_order(layers, order);
        const Spec spec = make_spec(scene, json::array({method}), 4, "rgba32f");
        Stage stage(*m_context, spec, spec.image.format);
        const Image image = stage.picture(spec.methods[0]);
        const Color truth = Compositor(scene, 4, {0.2, 0.4, 0.6}).pixel(1, 1, over_by_depth);
        // Layers 2 and 3 are exchanged: 0.4^2 (0.6 - 0.4 * 0.6) (blue - white).
        const double off = is_exact ? 0 : 0.0576;
        EXPECT_NEAR(image.pixel(1, 1)[0] - truth[0], off, 1e-6) << json(order).dump();
        EXPECT_NEAR(image.pixel(1, 1)[1] - truth[1], off, 1e-6) << json(order).dump();
        EXPECT_NEAR(image.pixel(1, 1)[2] - truth[2], 0, 1e-6) << json(order).dump();
    }
}

TEST_F(Mlab, ReportsHowMuchTheOrderChanges) {
    const json layers = layers_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    for (const auto& [nodes, change] : {std::pair{2, 0.0576}, {4, 0.0}}) {
        const Spec spec =
            make_spec(in_order(layers, {0, 1, 3, 2}), json::array({{{"id", "mlab"}, {"nodes", nodes}}}), 4, "rgba32f");
        NoAssets assets;
        const Scene scene(m_context->gl(), build_geometry(spec.scene, spec.image, assets), spec.scene);
        const Target target(m_context->gl(), spec.image, spec.image.format);
        gl::FrameTimer timer(*m_context);
        const auto method =
            find_method("mlab")->make({*m_context, m_context->gl(), scene, target}, spec.methods[0].parameters);
        const gl::FrameTimer::Frame frame = timer.frame(false);
        EXPECT_NEAR(method->findings(timer)["order"]["greatest_change"].get<double>(), change, 1e-6) << nodes;
    }
}

}  // namespace

}  // namespace sheer::test::mlab_test
