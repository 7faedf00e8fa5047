// The second reference, built on nothing that `exact` uses: depth peeling (Everitt, Interactive Order-Independent
// Transparency, NVIDIA 2001). Each pass draws everything and keeps, per pixel, the nearest fragment behind the one that
// the last pass kept; the layers are composited from near to far in 32-bit floats until a pass keeps nothing, and the
// picture is rounded once. Fragments of equal depth are told apart by their primitive, so that none is lost. Good at:
// being right without sorting, lists or atomics. Bad at: draws the whole scene once per layer. No parameters.
#include "renderer/frame/accumulation.h"
#include "renderer/frame/depth_peeler.h"
#include "renderer/frame/float_opaque.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

constexpr GLuint unit_layer = first_method_texture_unit + 4;

class DepthPeeling : public Method {
  public:
    explicit DepthPeeling(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_opaque(setup.gl, setup.scene, setup.target),
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

    std::int64_t memory_bytes() const override {
        return m_opaque.memory_bytes() + m_accumulation.memory_bytes() + m_peeler.memory_bytes();
    }

  private:
    void blend_layer() const {
        m_accumulation.begin_blending();
        m_gl.Disable(GL_DEPTH_TEST);
        m_gl.BindTextureUnit(unit_layer, m_peeler.color().id());
        m_blend.draw();
    }

    const gl::Functions& m_gl;
    FloatOpaque m_opaque;
    Accumulation m_accumulation;
    DepthPeeler m_peeler;
    FullscreenPass m_blend;
};

}  // namespace

MethodInfo method_depth_peeling() {
    return {
        .id = "depth_peeling",
        .name = "Depth peeling",
        .kind = "reference",
        .summary = "The scene is drawn once per layer; each pass keeps the nearest fragment that is left.",
        .paper = "Everitt, Interactive Order-Independent Transparency, NVIDIA, 2001",
        .good_at = "The right picture for any geometry with nothing but a depth test; checks the exact lists.",
        .bad_at = "Draws the whole scene as often as there are layers in the deepest pixel.",
        .memory = "84 bytes per pixel",
        .needs_sorting = false,
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<DepthPeeling>(setup);
        },
    };
}

}  // namespace sheer
