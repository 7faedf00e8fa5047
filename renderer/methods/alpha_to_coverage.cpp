// Alpha to coverage: one of the alternatives that Hathaway weighs in "Alpha Blending as a Post-Process", GPU Pro
// (2010), section 3.2. The alpha of a fragment becomes a mask of the samples that it covers (OpenGL 4.5,
// section 17.3.1); these are drawn as if they were opaque, with depth test and depth writes per sample, and resolved to
// their mean. Good at: softer edges than alpha testing without sorting. Bad at: as many levels as samples; layers of
// like alpha cover the same samples, so that the near one hides the far one whole; the mask's rule is the device's own.
// Parameters: `samples` 2 or 4, 4; `reference` 0..1, 0: fragments of less alpha are dropped first (0 drops none).
#include <optional>

#include "renderer/frame/multisample.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

class AlphaToCoverage : public Method {
  public:
    explicit AlphaToCoverage(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_multisample(setup.gl, setup.target, setup.parameters.at("samples").get<int>()),
          m_program(setup.scene.make_program("alpha to coverage", gl::shader_file("methods/alpha_to_coverage.glsl"))) {
        const int wanted = setup.parameters.at("samples").get<int>();
        // More samples would be more levels: another picture than the one asked for.
        if (m_multisample.samples() != wanted)
            throw Unsupported("samples " + std::to_string(wanted) + ": this device has " +
                              std::to_string(m_multisample.samples()) + " samples per pixel at least");
        m_program.set("u_least_alpha", setup.scene.least_alpha(setup.parameters.at("reference")));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw_into(m_multisample.framebuffer(), timer);
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            begin_pass(m_gl, m_multisample.framebuffer(), m_target.width_px(), m_target.height_px());
            m_gl.Enable(GL_DEPTH_TEST);
            m_gl.DepthFunc(GL_LEQUAL);
            m_gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // alpha is for the coverage alone
            m_gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
            m_scene.draw_transparent(m_program, Order::submission);
        }
        const auto pass = timer.pass("resolve", gl::Phase::finalization);
        m_multisample.resolve_color();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        nlohmann::json samples = nlohmann::json::array();
        for (const Multisample::Sample& sample : m_multisample.read(trace.x(), trace.y())) {
            const std::optional<std::size_t> fragment = trace.at_depth(sample.depth);
            samples.push_back({{"fragment", fragment ? nlohmann::json(*fragment) : nlohmann::json()},
                               {"color", {sample.color.r, sample.color.g, sample.color.b}}});
        }
        return {{"samples", "samples", samples,
                 "What each sample of the pixel holds, and the fragment at its depth, none where what is opaque is "
                 "left; the pixel is their mean."}};
    }

    std::int64_t memory_bytes() const override { return m_multisample.memory_bytes(); }

  private:
    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    OpaquePass m_opaque;
    Multisample m_multisample;
    gl::Program m_program;
};

}  // namespace

MethodInfo method_alpha_to_coverage() {
    return {
        .id = "alpha_to_coverage",
        .name = "Alpha to coverage",
        .kind = "unsorted, no blending",
        .summary = "A fragment's alpha decides how many of the pixel's samples it covers, as if it were opaque.",
        .paper =
            "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010, section 3.2 (an alternative weighed there)",
        .good_at = "Softer edges than alpha testing, without sorting; intersections are resolved per sample.",
        .bad_at = "As many levels of alpha as samples; a near layer hides a far one of like alpha whole.",
        .memory = "for each sample one pixel of the image format and 4 bytes of depth",
        .needs_sorting = false,
        .parameters = {Param::integer("samples",
                                      "2 or 4 samples per pixel: the levels of coverage beside none; unsupported "
                                      "where the device does not have just as many",
                                      "samples", 4, 2, 4)
                           .in_steps_of(2),
                       Param::number("reference", "fragments of less alpha are dropped first; 0 drops none", "", 0, 0,
                                     1)},
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<AlphaToCoverage>(setup);
        },
    };
}

}  // namespace sheer
