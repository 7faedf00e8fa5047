// The second reference, built on nothing that `exact` uses: depth peeling (Everitt, Interactive Order-Independent
// Transparency, NVIDIA 2001). Each pass draws everything and keeps, per pixel, the nearest fragment behind the one that
// the last pass kept; the layers are composited from near to far in 32-bit floats until a pass keeps nothing. Fragments
// of equal depth are told apart by their primitive, so that none is lost. Good at: being right without sorting, lists
// or atomics. Bad at: draws the whole scene once per layer. No parameters.
#include <array>

#include "renderer/frame/accumulation.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

constexpr GLuint unit_depth = first_method_texture_unit + 1, unit_last_depth = unit_depth + 1,
                 unit_last_primitive = unit_depth + 2, unit_layer = unit_depth + 3;

class DepthPeeling : public Method {
  public:
    explicit DepthPeeling(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, PixelFormat::rgba32f),
          m_peel(setup.scene.make_program("depth peeling: peel", gl::shader_file("methods/depth_peeling_peel.glsl"))),
          m_blend(setup.gl, "depth peeling: blend", gl::shader_file("methods/depth_peeling_blend.glsl")),
          m_any_fragment(gl::make_query(setup.gl, "depth peeling: any fragment", GL_ANY_SAMPLES_PASSED)),
          m_depth(texture("depth", GL_DEPTH_COMPONENT32F)) {
        for (Layer& layer : m_layers) {
            layer.color = texture("color", GL_RGBA32F);
            layer.depth = texture("fragment depth", GL_R32F);
            layer.primitive = texture("fragment primitive", GL_R32UI);
            layer.framebuffer = gl::make_framebuffer(
                m_gl, "depth peeling: layer", std::array{layer.color.id(), layer.depth.id(), layer.primitive.id()},
                m_depth.id());
        }
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("peel", gl::Phase::transparent);
            m_accumulation.clear(1);
            clear(m_layers[1], -1);
            for (std::size_t i = 0; peel(m_layers[i % 2], m_layers[1 - i % 2]); ++i) blend(m_layers[i % 2]);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_accumulation.composite();
    }

    std::int64_t memory_bytes() const override {
        const std::int64_t pixels = std::int64_t{m_target.width_px()} * m_target.height_px();
        return m_accumulation.memory_bytes() + pixels * (2 * 24 + 4);
    }

  private:
    struct Layer {
        gl::Texture color, depth, primitive;
        gl::Framebuffer framebuffer;
    };

    gl::Texture texture(const std::string& what, GLenum format) const {
        return gl::make_texture_2d(m_gl, "depth peeling: " + what, format, m_target.width_px(), m_target.height_px());
    }

    /// `depth` is what the next pass finds where this one keeps nothing: -1 is before everything, 2 behind everything.
    void clear(const Layer& layer, float depth) const {
        begin_pass(m_gl, layer.framebuffer, m_target.width_px(), m_target.height_px());
        const glm::vec4 no_color(0), no_depth(depth);
        const glm::uvec4 no_primitive(0);
        const float far_depth = 1;
        m_gl.ClearBufferfv(GL_COLOR, 0, &no_color[0]);
        m_gl.ClearBufferfv(GL_COLOR, 1, &no_depth[0]);
        m_gl.ClearBufferuiv(GL_COLOR, 2, &no_primitive[0]);
        m_gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
    }

    /// Whether a fragment was left. Drawn in submission order with LEQUAL, so that of equal depths the later submitted
    /// wins, which is the one that counts as nearer.
    bool peel(const Layer& layer, const Layer& last) const {
        clear(layer, 2);
        m_gl.Enable(GL_DEPTH_TEST);
        m_gl.DepthFunc(GL_LEQUAL);
        m_gl.BindTextureUnit(unit_depth, m_target.depth().id());
        m_gl.BindTextureUnit(unit_last_depth, last.depth.id());
        m_gl.BindTextureUnit(unit_last_primitive, last.primitive.id());
        m_gl.BeginQuery(GL_ANY_SAMPLES_PASSED, m_any_fragment.id());
        m_scene.draw_transparent(m_peel, Order::submission);
        m_gl.EndQuery(GL_ANY_SAMPLES_PASSED);
        GLuint any = 0;
        m_gl.GetQueryObjectuiv(m_any_fragment.id(), GL_QUERY_RESULT, &any);
        return any != 0;
    }

    void blend(const Layer& layer) const {
        m_accumulation.begin_blending();
        m_gl.Disable(GL_DEPTH_TEST);
        m_gl.BindTextureUnit(unit_layer, layer.color.id());
        m_blend.draw();
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    gl::Program m_peel;
    FullscreenPass m_blend;
    gl::Query m_any_fragment;
    gl::Texture m_depth;
    Layer m_layers[2];
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
        .memory = "68 bytes per pixel",
        .needs_sorting = false,
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<DepthPeeling>(setup);
        },
    };
}

}  // namespace sheer
