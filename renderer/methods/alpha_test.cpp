// Alpha testing: one of the alternatives that Hathaway weighs in "Alpha Blending as a Post-Process", GPU Pro (2010),
// section 3.2. A fragment is either dropped or drawn as if it were opaque, with depth test and depth writes.
// Good at: no sorting, no blending, intersections right per pixel. Bad at: translucency is lost, edges are jagged.
// Parameters: `reference` 0..1, 0.5: the least alpha that is drawn; `order` submission or near_to_far, which gives the
// depth test something to reject, as the section says; the picture is the same.
#include <algorithm>

#include "renderer/methods/method.h"

namespace sheer {

namespace {

class AlphaTest : public Method {
  public:
    explicit AlphaTest(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_order(setup.parameters.at("order") == "near_to_far" ? Order::near_to_far : Order::submission),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_program(setup.scene.make_program("alpha test", gl::shader_file("methods/alpha_test.glsl"))) {
        m_program.set("u_least_alpha", setup.scene.least_alpha(setup.parameters.at("reference")));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
        m_gl.Enable(GL_DEPTH_TEST);
        m_gl.DepthFunc(GL_LEQUAL);
        m_scene.draw_transparent(m_program, m_order);
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const PixelTrace::Draws draws = trace.of(m_program);
        std::vector<std::size_t> dropped = draws.failed();
        std::ranges::sort(dropped);
        return {fragment_fact("shown", draws.last_passed(),
                              "The fragment that is seen, the last that was drawn; none if what is behind is seen."),
                fragments_fact("drawn", draws.passed(),
                               "The fragments that passed the alpha and the depth test, in the order of drawing; "
                               "each hides the ones before it."),
                fragments_fact("dropped", dropped, "The fragments of too little alpha, or behind one drawn before.")};
    }

  private:
    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    Order m_order;
    OpaquePass m_opaque;
    gl::Program m_program;
};

}  // namespace

MethodInfo method_alpha_test() {
    return {
        .id = "alpha_test",
        .name = "Alpha test",
        .kind = "unsorted, no blending",
        .summary = "Fragments of little alpha are dropped, all others are drawn as if they were opaque.",
        .paper =
            "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010, section 3.2 (an alternative weighed there)",
        .good_at = "No sorting, no blending, no extra memory; intersecting primitives are resolved per pixel.",
        .bad_at = "Nothing is translucent any more; edges are jagged and sparkle in motion.",
        .memory = "0 bytes per pixel",
        .needs_sorting = false,
        .sorts_here = [](const Scene&,
                         const nlohmann::json& parameters) { return parameters.at("order") == "near_to_far"; },
        .parameters = {Param::number("reference", "the least alpha that is drawn; at 0 everything is", "", 0.5, 0, 1),
                       Param::choice("order", "as submitted, or sorted so that near fragments stop far ones",
                                     "submission", {"submission", "near_to_far"})},
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> { return std::make_unique<AlphaTest>(setup); },
    };
}

}  // namespace sheer
