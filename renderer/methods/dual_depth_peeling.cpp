// Dual depth peeling: Bavoil and Myers, Order Independent Transparency with Dual Depth Peeling (NVIDIA 2008),
// section 2. Each pass over the scene takes the nearest and the farthest of the layers that are left: near ones are
// blended from near to far, far ones from far to near. The depths of the next two are found in the same pass by MAX
// blending of
// (-depth, depth). In contrast to the paper, a pass blends the fragments of equal depth in the order of submission into
// a layer of their own, so none is lost, and everything is in 32-bit floats and rounded once.
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/float_opaque.h"

namespace sheer {

namespace {

class DualDepthPeeling : public Method {
  public:
    DualDepthPeeling(const MethodSetup& setup, const NoParameters&)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, PixelFormat::rgba32f),
          m_near(setup.target.make_texture("dual depth peeling: near layer", GL_RGBA32F)),
          m_far(setup.target.make_texture("dual depth peeling: far layers", GL_RGBA32F)),
          m_first(setup.scene.make_program("dual depth peeling: bounds", source("bounds"))),
          m_peel(setup.scene.make_program("dual depth peeling: peel", source("peel"))),
          m_blend_near(setup.gl, "dual depth peeling: near", source("near")),
          m_left(setup.gl, "dual depth peeling: left", source("left")),
          m_composite(setup.gl, "dual depth peeling: composite", source("composite")),
          m_any_left(gl::make_query(setup.gl, "dual depth peeling: any left", GL_ANY_SAMPLES_PASSED)) {
        for (Bounds& bounds : m_bounds) {
            const GLuint depth = m_target.depth().id();
            bounds.depths = m_target.make_texture("dual depth peeling: bounds", GL_RG32F);
            bounds.alone =
                gl::make_framebuffer(m_gl, "dual depth peeling: bounds", std::array{bounds.depths.id()}, depth);
            bounds.with_layers = gl::make_framebuffer(m_gl, "dual depth peeling: layers",
                                                      std::array{bounds.depths.id(), m_near.id(), m_far.id()}, depth);
        }
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("peel", gl::Phase::transparent);
            m_accumulation.clear(1);
            find_bounds();
            m_passes = 1;
            bool is_first = true;
            while (any_left()) {
                peel(is_first);
                is_first = false;
                ++m_passes;
            }
            if (is_first) clear_far();
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        const Pass drawing(m_gl, m_target);
        m_composite.program().set_texture("u_opaque", m_opaque.color());
        m_composite.program().set_texture("u_near", m_accumulation.color());
        m_composite.program().set_texture("u_far", m_far);
        m_composite.draw();
    }

    /// {"peeling": {"passes"}}: how often the scene was drawn in the last frame.
    nlohmann::json findings(gl::FrameTimer&) override { return {{"peeling", {{"passes", m_passes}}}}; }

    std::int64_t memory_bytes() const override {
        return gl::memory_bytes_of(m_opaque, m_accumulation, m_near, m_far, m_bounds[0].depths, m_bounds[1].depths);
    }

  private:
    struct Bounds {
        gl::Texture depths;
        gl::Framebuffer alone, with_layers;
    };

    static std::string source(const std::string& pass) {
        return gl::shader_file("methods/dual_depth_peeling_" + pass + ".glsl");
    }

    Pass begin(const gl::Framebuffer& framebuffer) const {
        return {m_gl, framebuffer, m_target.width_px(), m_target.height_px()};
    }

    /// Under any pair of bounds.
    static glm::vec4 no_bounds() { return glm::vec4(-2); }

    void clear_far() const { begin(m_bounds[m_current].with_layers).clear_color(glm::vec4(0), 2); }

    void find_bounds() {
        Pass drawing = begin(m_bounds[m_current].alone);
        drawing.clear_color(no_bounds());
        drawing.transparent_depth();
        drawing.blend(GL_ONE, GL_ONE);
        drawing.blend_equation(GL_MAX, GL_MAX);
        m_scene.draw_transparent(m_first, Order::submission);
    }

    /// Waits for the device.
    bool any_left() const {
        Pass drawing = begin(m_accumulation.framebuffer());
        drawing.no_color();
        m_left.program().set_texture("u_bounds", m_bounds[m_current].depths);
        m_gl.BeginQuery(GL_ANY_SAMPLES_PASSED, m_any_left.id());
        m_left.draw();
        m_gl.EndQuery(GL_ANY_SAMPLES_PASSED);
        GLuint any = 0;
        m_gl.GetQueryObjectuiv(m_any_left.id(), GL_QUERY_RESULT, &any);
        return any != 0;
    }

    void peel(bool is_first) {
        const Bounds& last = m_bounds[m_current];
        m_current = 1 - m_current;
        {
            Pass drawing = begin(m_bounds[m_current].with_layers);
            drawing.clear_color(no_bounds());
            drawing.clear_color(glm::vec4(0), 1);
            if (is_first) drawing.clear_color(glm::vec4(0), 2);
            drawing.transparent_depth();
            drawing.blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
            drawing.blend_equation_output(0, GL_MAX);
            m_peel.set_texture("u_bounds", last.depths);
            m_scene.draw_transparent(m_peel, Order::submission);
        }
        Pass drawing = m_accumulation.blending();
        drawing.no_depth_test();
        m_blend_near.program().set_texture("u_near", m_near);
        m_blend_near.draw();
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    FloatOpaque m_opaque;
    Accumulation m_accumulation;
    gl::Texture m_near, m_far;
    Bounds m_bounds[2];
    int m_current = 0;
    gl::Program m_first, m_peel;
    FullscreenPass m_blend_near, m_left, m_composite;
    gl::Query m_any_left;
    int m_passes = 0;
};

}  // namespace

MethodInfo method_dual_depth_peeling() {
    return describe_method(
        {
            .id = "dual_depth_peeling",
            .name = "Dual depth peeling",
            .kind = "exact without sorting",
            .summary = "Each pass over the scene takes the nearest and the farthest layer that is left.",
            .paper =
                "Bavoil and Myers, Order Independent Transparency with Dual Depth Peeling, NVIDIA, 2008, section 2",
            .good_at = "The correct picture for any geometry, in half as many passes as depth peeling: N / 2 + 1.",
            .bad_at = "Draws the whole scene once for every two layers of the deepest pixel.",
            .memory = "80 bytes per pixel",
            .passes = "1 and a full-screen one for every two layers, and one more",
            .needs = "float targets with the blend equation MAX; occlusion queries",
            .needs_sorting = false,
        },
        NoParameters::table(), make_new<DualDepthPeeling>, pixels_and_bytes(0, 80));
}

}  // namespace sheer
