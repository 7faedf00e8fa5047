// Depth marks: early ray termination of Krueger and Westermann, "Acceleration Techniques for GPU-based Volume
// Rendering", VIS 2003, as told in Vlcek, Havel, Herout, SCCG 2010, sections 1 and 4. Front-to-back blending; after
// every `interval` primitives an invisible full-screen pass writes the nearest depth where the transmittance that is
// left is under `threshold`. From then on the depth test rejects fragments of those pixels before they are shaded. A
// marked pixel fails the depth test of later marks, so that it is written once. Good at: no shader starts for a hidden
// fragment; needs no reading of the render target. Bad at: each mark reads the whole picture; what comes between
// saturation and the next mark is shaded in vain. Parameters: `interval` primitives between marks, 1..1000000, 16;
// `threshold` 0..1, 0.01 (at 0 nothing is marked).
#include <algorithm>
#include <span>

#include "renderer/frame/accumulation.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

class DepthMarks : public Method {
  public:
    explicit DepthMarks(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_interval(setup.parameters.at("interval").get<std::size_t>()),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, setup.target.format()),
          m_program(setup.scene.make_program("depth marks", gl::shader_file("methods/f2b.glsl"),
                                             "layout(early_fragment_tests) in;\n")),
          m_mark(setup.gl, "depth marks: mark", gl::shader_file("common/saturated.glsl")),
          m_depth_only(
              gl::make_framebuffer(setup.gl, "depth marks", std::span<const GLuint>(), setup.target.depth().id())) {
        m_mark.program().set("u_threshold", setup.parameters.at("threshold").get<float>());
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_accumulation.clear(1);
        }
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            const std::size_t count = m_scene.transparent_count();
            for (std::size_t first = 0; first < count; first += m_interval) {
                if (first > 0) mark();
                m_accumulation.begin_blending();
                m_scene.draw_transparent(m_program, Order::near_to_far, first, std::min(m_interval, count - first));
            }
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_accumulation.composite();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const PixelTrace::Draws draws = trace.of(m_program);
        const std::vector<std::size_t> rejected = draws.failed();
        std::vector<PixelFact> facts = {
            fragments_fact("blended", draws.passed(),
                           "The fragments that were shaded, those in vain included that came between saturation and "
                           "the mark."),
            fragments_fact("rejected", rejected, "The fragments that failed the depth test against the mark."),
            fragment_fact("marked_before", rejected.empty() ? std::nullopt : std::optional(rejected.front()),
                          "The first fragment that found the pixel marked; none if it was not marked in time.")};
        add_accumulated(facts, draws.color);
        return facts;
    }

    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    /// The marks go into the target's own depth, which nothing needs after the opaque pass but the depth test.
    void mark() const {
        begin_pass(m_gl, m_depth_only, m_target.width_px(), m_target.height_px());
        m_gl.Enable(GL_DEPTH_TEST);
        m_gl.DepthFunc(GL_LESS);
        m_gl.BindTextureUnit(first_method_texture_unit, m_accumulation.readable_alpha().id());
        m_mark.draw();
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    std::size_t m_interval;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    gl::Program m_program;
    FullscreenPass m_mark;
    gl::Framebuffer m_depth_only;
};

}  // namespace

MethodInfo method_depth_marks() {
    return {
        .id = "depth_marks",
        .name = "Depth marks",
        .kind = "sorted blending with early discard",
        .summary = "F2B; now and then the nearest depth is written where the pixel is already as good as opaque.",
        .paper = "Krueger and Westermann, Acceleration Techniques for GPU-based Volume Rendering, VIS 2003",
        .good_at = "Hidden fragments fail the depth test before any shader starts; no feedback, no barriers.",
        .bad_at =
            "A full-screen pass and state changes after every few primitives; what lies between saturation and "
            "the next mark is shaded in vain.",
        .memory = "one pixel of the image format",
        .parameters = {Param::integer("interval", "primitives between marks", "", 16, 1, 1000000),
                       Param::number("threshold",
                                     "a pixel is marked where less than this transmittance is left; at 0 none is", "",
                                     0.01, 0, 1)},
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> { return std::make_unique<DepthMarks>(setup); },
    };
}

}  // namespace sheer
