// Alpha to coverage: one of the alternatives that Hathaway discusses in "Alpha Blending as a Post-Process", GPU Pro
// (2010), section 3.2. The alpha of a fragment becomes a mask of the samples that it covers (OpenGL 4.5,
// section 17.3.1); these are drawn as if they were opaque, with depth test and depth writes per sample, and resolved to
// their mean. Layers of equal alpha cover the same samples; the device decides which.
#include <optional>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/multisample.h"

namespace sheer {

namespace {

struct CoverageParameters {
    int samples = 4;
    double reference = 0;

    static ParamTable<CoverageParameters> table() {
        return ParamTable<CoverageParameters>()
            .integer(&CoverageParameters::samples, "samples",
                     "2 or 4 samples per pixel: the levels of coverage besides none; unsupported if the device does "
                     "not have exactly as many",
                     "samples", 2, 4)
            .in_steps_of(2)
            .number(&CoverageParameters::reference, "reference",
                    "fragments with less alpha are dropped first; 0 drops none", "", 0, 1);
    }
};

class AlphaToCoverage : public OpaqueFirst {
  public:
    AlphaToCoverage(const MethodSetup& setup, const CoverageParameters& parameters)
        : OpaqueFirst(setup),
          m_multisample(setup.gl, setup.target, parameters.samples),
          m_program(setup.scene.make_program("alpha to coverage", gl::shader_file("methods/alpha_to_coverage.glsl"))) {
        // More samples would be more levels, and so not the requested picture.
        if (m_multisample.samples() != parameters.samples)
            throw Unsupported("samples " + std::to_string(parameters.samples) + ": this device has " +
                              std::to_string(m_multisample.samples()) + " samples per pixel at least");
        m_program.set("u_least_alpha", setup.scene.least_alpha(parameters.reference));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw_into(m_multisample.framebuffer(), timer);
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            Pass drawing = begin(m_multisample.framebuffer());
            drawing.depth_test(GL_LEQUAL);
            drawing.color_mask(true, true, true, false);  // alpha is for the coverage alone
            drawing.alpha_to_coverage();
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
                 "The value of each sample of the pixel, and the fragment at its depth, or none if the sample shows "
                 "an opaque surface; the pixel is their mean."}};
    }

    std::int64_t memory_bytes() const override { return m_multisample.memory_bytes(); }

  private:
    Multisample m_multisample;
    gl::Program m_program;
};

}  // namespace

MethodInfo method_alpha_to_coverage() {
    return describe_method(
        {
            .id = "alpha_to_coverage",
            .name = "Alpha to coverage",
            .kind = "unsorted, no blending",
            .summary = "A fragment's alpha decides how many of the pixel's samples it covers, as if it were opaque.",
            .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010, section 3.2 (an alternative discussed "
                     "there)",
            .good_at = "Softer edges than alpha testing, without sorting; intersections are resolved per sample.",
            .bad_at =
                "Only as many levels of alpha as samples; a near layer hides a far one of equal alpha completely.",
            .memory = "for each sample one pixel of the image format and 4 bytes of depth",
            .passes = "1",
            .needs = "multisampling",
            .needs_sorting = false,
        },
        CoverageParameters::table(), make_new<AlphaToCoverage>,
        [](const CoverageParameters& parameters, int pixel_bytes) -> std::optional<double> {
            return parameters.samples * (pixel_bytes + 4.0);
        });
}

}  // namespace sheer
