// Depth marks: early ray termination of Krueger and Westermann, "Acceleration Techniques for GPU-based Volume
// Rendering", VIS 2003, as described in Vlcek, Havel, Herout, SCCG 2010, sections 1 and 4. Front-to-back blending;
// after every `interval` primitives an invisible full-screen pass writes the nearest depth where the remaining
// transmittance is under `threshold`. From then on the depth test rejects fragments of those pixels before they are
// shaded. A marked pixel fails the depth test of later marks, so it is written only once.
#include <algorithm>
#include <span>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"

namespace sheer {

namespace {

struct DepthMarksParameters {
    std::size_t interval = 16;
    double threshold = 0.01;

    static ParamTable<DepthMarksParameters> table() {
        return ParamTable<DepthMarksParameters>()
            .integer(&DepthMarksParameters::interval, "interval", "primitives between marks", "", 1, 1000000)
            .number(&DepthMarksParameters::threshold, "threshold",
                    "a pixel is marked when less than this transmittance is left; 0 marks none", "", 0, 1);
    }
};

class DepthMarks : public OpaqueFirst {
  public:
    DepthMarks(const MethodSetup& setup, const DepthMarksParameters& parameters)
        : OpaqueFirst(setup),
          m_interval(parameters.interval),
          m_accumulation(setup.gl, setup.target, setup.target.format()),
          m_program(setup.scene.make_program("depth marks", gl::shader_file("methods/f2b.glsl"),
                                             "layout(early_fragment_tests) in;\n")),
          m_mark(setup.gl, "depth marks: mark", gl::shader_file("common/saturated.glsl")),
          m_depth_only(
              gl::make_framebuffer(setup.gl, "depth marks", std::span<const GLuint>(), setup.target.depth().id())) {
        m_mark.program().set("u_threshold", static_cast<float>(parameters.threshold));
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
                const Pass drawing = m_accumulation.blending();
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
                           "The fragments that were shaded, including those shaded in vain between saturation and the "
                           "mark."),
            fragments_fact("rejected", rejected, "The fragments that failed the depth test against the mark."),
            fragment_fact(
                "marked_before", rejected.empty() ? std::nullopt : std::optional(rejected.front()),
                "The first fragment at which the pixel was already marked; none if it was not marked in time.")};
        add_accumulated(facts, draws.color);
        return facts;
    }

    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    /// The marks go into the target's own depth, which after the opaque pass is needed only by the depth test.
    void mark() const {
        Pass marking = begin(m_depth_only);
        marking.depth_test(GL_LESS);
        m_mark.program().set_texture("u_accumulation", m_accumulation.readable_alpha());
        m_mark.draw();
    }

    std::size_t m_interval;
    Accumulation m_accumulation;
    gl::Program m_program;
    FullscreenPass m_mark;
    gl::Framebuffer m_depth_only;
};

}  // namespace

MethodInfo method_depth_marks() {
    return describe_method(
        {
            .id = "depth_marks",
            .name = "Depth marks",
            .kind = "sorted blending with early discard",
            .summary = "F2B; at intervals, the nearest depth is written to pixels that are already practically opaque.",
            .paper = "Krueger and Westermann, Acceleration Techniques for GPU-based Volume Rendering, VIS 2003",
            .good_at = "Hidden fragments fail the depth test before any shader starts; no feedback, no barriers.",
            .bad_at =
                "A full-screen pass and state changes after every few primitives; fragments between saturation and "
                "the next mark are shaded in vain.",
            .memory = "one pixel of the image format",
            .passes = "1, and full-screen ones: a mark after every few primitives, and the end",
            .needs = "a depth that the shader writes",
            .saturation_parameter = "threshold",
        },
        DepthMarksParameters::table(), make_new<DepthMarks>, pixels_and_bytes(1));
}

}  // namespace sheer
