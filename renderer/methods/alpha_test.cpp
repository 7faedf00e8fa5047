// Alpha testing: one of the alternatives that Hathaway discusses in "Alpha Blending as a Post-Process", GPU Pro (2010),
// section 3.2. A fragment is either dropped or drawn as if it were opaque, with depth test and depth writes.
#include <algorithm>

#include "renderer/methods/shared/method.h"

namespace sheer {

namespace {

struct AlphaTestParameters {
    double reference = 0.5;
    Order order = Order::submission;

    static ParamTable<AlphaTestParameters> table() {
        return ParamTable<AlphaTestParameters>()
            .number(&AlphaTestParameters::reference, "reference", "the least alpha that is drawn; 0 draws everything",
                    "", 0, 1)
            .choice(&AlphaTestParameters::order, "order",
                    "as submitted, or sorted so that near fragments stop far ones",
                    {{"submission", Order::submission}, {"near_to_far", Order::near_to_far}});
    }
};

class AlphaTest : public OpaqueFirst {
  public:
    AlphaTest(const MethodSetup& setup, const AlphaTestParameters& parameters)
        : OpaqueFirst(setup),
          m_order(parameters.order),
          m_program(setup.scene.make_program("alpha test", gl::shader_file("methods/alpha_test.glsl"))) {
        m_program.set("u_least_alpha", setup.scene.least_alpha(parameters.reference));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        Pass drawing = begin();
        drawing.depth_test(GL_LEQUAL);
        m_scene.draw_transparent(m_program, m_order);
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const PixelTrace::Draws draws = trace.of(m_program);
        std::vector<std::size_t> dropped = draws.failed();
        std::ranges::sort(dropped);
        return {fragment_fact("shown", draws.last_passed(),
                              "The visible fragment, which was drawn last; none if the background is visible."),
                fragments_fact("drawn", draws.passed(),
                               "The fragments that passed the alpha and the depth test, in the order of drawing; "
                               "each hides the ones before it."),
                fragments_fact("dropped", dropped,
                               "The fragments whose alpha is too low, or that are behind one drawn earlier.")};
    }

  private:
    Order m_order;
    gl::Program m_program;
};

}  // namespace

MethodInfo method_alpha_test() {
    return describe_method(
        {
            .id = "alpha_test",
            .name = "Alpha test",
            .kind = "unsorted, no blending",
            .summary = "Fragments with a low alpha are dropped; all others are drawn as if they were opaque.",
            .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010, section 3.2 (an alternative discussed "
                     "there)",
            .good_at = "No sorting, no blending, no extra memory; intersecting primitives are resolved per pixel.",
            .bad_at = "Nothing stays translucent; edges are jagged and sparkle in motion.",
            .memory = "0 bytes per pixel",
            .passes = "1",
            .needs_sorting = false,
        },
        AlphaTestParameters::table(), make_new<AlphaTest>, pixels_and_bytes(0),
        [](const Scene&, const AlphaTestParameters& parameters) { return parameters.order == Order::near_to_far; });
}

}  // namespace sheer
