// The second reference, which shares nothing with `exact`: depth peeling (Everitt, Interactive Order-Independent
// Transparency, NVIDIA 2001). Each pass draws everything and keeps, per pixel, the nearest fragment behind the one that
// the last pass kept; the layers are composited from near to far in 32-bit floats until a pass keeps nothing, and the
// picture is rounded once. Fragments of equal depth are distinguished by their primitive, so none is lost.
#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/depth_peeler.h"
#include "renderer/passes/float_opaque.h"

namespace sheer {

namespace {

class DepthPeeling : public Method {
  public:
    DepthPeeling(const MethodSetup& setup, const NoParameters&)
        : m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, PixelFormat::rgba32f),
          m_peeler(setup.gl, setup.scene, setup.target),
          m_blend(setup.gl, "depth peeling: blend", gl::shader_file("methods/depth_peeling_blend.glsl")) {}

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("peel", gl::Phase::transparent);
            m_accumulation.clear(1);
            m_peeler.begin();
            while (m_peeler.next()) blend_layer();
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_opaque.composite(m_accumulation.color());
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_opaque, m_accumulation, m_peeler); }

  private:
    void blend_layer() const {
        Pass drawing = m_accumulation.blending();
        drawing.no_depth_test();
        m_blend.program().set_texture("u_layer", m_peeler.color());
        m_blend.draw();
    }

    FloatOpaque m_opaque;
    Accumulation m_accumulation;
    DepthPeeler m_peeler;
    FullscreenPass m_blend;
};

}  // namespace

MethodInfo method_depth_peeling() {
    return describe_method(
        {
            .id = "depth_peeling",
            .name = "Depth peeling",
            .kind = "reference",
            .summary = "The scene is drawn once per layer; each pass keeps the nearest remaining fragment.",
            .paper = "Everitt, Interactive Order-Independent Transparency, NVIDIA, 2001",
            .good_at = "The correct picture for any geometry with only a depth test; checks the exact lists.",
            .bad_at = "Draws the whole scene as often as there are layers in the deepest pixel.",
            .memory = "84 bytes per pixel",
            .passes = "1 and a full-screen one for each layer, and one more",
            .needs = "float targets; occlusion queries",
            .needs_sorting = false,
        },
        NoParameters::table(), make_new<DepthPeeling>, pixels_and_bytes(0, 84));
}

}  // namespace sheer
