// Stochastic transparency: Enderton, Sintorn, Shirley, Luebke, Stochastic Transparency, I3D 2010. Each fragment covers
// a random part of the pixel's samples, as many as its alpha says, and is drawn into these as if it were opaque; the
// mean of the samples is right. For a surface's weight w_i and the result C, the variance of one sample is sum w_i
// C_i^2 - C^2, and that of the mean of n independent ones is the n-th part. (Sections 2 and 3.) Alpha correction
// (section 4): the share of the samples that are covered is replaced by the true 1 - prod (1 - A_i), which takes
// another pass. It removes most of the noise and costs the exact mean.
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/multisample.h"

namespace sheer {

namespace {

struct StochasticParameters {
    enum class Masks { stratified, independent };
    enum class Variant { color, depth };

    int samples = 4;
    int passes = 1;
    Masks masks = Masks::stratified;
    Variant variant = Variant::color;
    bool alpha_correction = false;
    std::int64_t seed = 0;

    static ParamTable<StochasticParameters> table() {
        return ParamTable<StochasticParameters>()
            .integer(&StochasticParameters::samples, "samples",
                     "samples per pixel in a pass; unsupported if the device does not have exactly as many", "samples",
                     2, 16)
            .in_steps_of(2)
            .integer(&StochasticParameters::passes, "passes", "passes whose samples are averaged", "", 1, 65536)
            .choice(&StochasticParameters::masks, "masks",
                    "stratified: a fragment covers alpha times as many samples, rounded up or down at random; "
                    "independent: it covers each one with the probability alpha",
                    {{"stratified", Masks::stratified}, {"independent", Masks::independent}})
            .choice(
                &StochasticParameters::variant, "variant",
                "color: the mean of what the samples show; depth: every fragment, weighted by how many of the samples "
                "it is seen in",
                {{"color", Variant::color}, {"depth", Variant::depth}})
            .boolean(&StochasticParameters::alpha_correction, "alpha_correction",
                     "the opaque color gets its true weight, which takes another pass over the scene")
            .integer(&StochasticParameters::seed, "seed", "other numbers give other noise", "", 0, 1000000);
    }
};

class Stochastic : public OpaqueFirst {
  public:
    Stochastic(const MethodSetup& setup, const StochasticParameters& parameters)
        : OpaqueFirst(setup),
          m_passes(parameters.passes),
          m_seed(static_cast<unsigned>(parameters.seed)),
          m_corrected(parameters.alpha_correction),
          m_by_depth(parameters.variant == StochasticParameters::Variant::depth),
          m_multisample(setup.gl, setup.target, parameters.samples),
          m_sample(setup.scene.make_program(
              "stochastic: sample",
              gl::shader_file("common/hash.glsl") + gl::shader_file("methods/stochastic_sample.glsl"),
              prolog(parameters))),
          m_add(setup.gl, "stochastic: add", gl::shader_file("methods/stochastic_add.glsl"), prolog(parameters)),
          m_composite(setup.gl, "stochastic: composite", gl::shader_file("methods/stochastic_composite.glsl"),
                      prolog(parameters)),
          m_sum(setup.target.make_texture("stochastic: sum", GL_RGBA32F)),
          m_sum_framebuffer(gl::make_framebuffer(setup.gl, "stochastic: sum", std::array{m_sum.id()}, 0)) {
        if (m_multisample.samples() != parameters.samples)
            throw Unsupported("samples " + std::to_string(parameters.samples) + ": this device has " +
                              std::to_string(m_multisample.samples()) + " samples per pixel at least");
        m_composite.program().set("u_samples", static_cast<float>(parameters.samples) * static_cast<float>(m_passes));
        if (m_by_depth) {
            m_sum_with_depth =
                gl::make_framebuffer(m_gl, "stochastic: sum", std::array{m_sum.id()}, m_target.depth().id());
            m_accumulate = setup.scene.make_program(
                "stochastic: accumulate", gl::shader_file("methods/stochastic_accumulate.glsl"), prolog(parameters));
        }
        if (!m_corrected) return;
        m_transmittance = m_target.make_texture("stochastic: transmittance", GL_R32F);
        m_transmittance_framebuffer = gl::make_framebuffer(m_gl, "stochastic: transmittance",
                                                           std::array{m_transmittance.id()}, m_target.depth().id());
        m_alpha = setup.scene.make_program("stochastic: transmittance",
                                           gl::shader_file("methods/stochastic_transmittance.glsl"));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            begin(m_sum_framebuffer).clear_color(glm::vec4(0));
        }
        for (int number = 0; number < m_passes; ++number) {
            m_opaque.draw_into(m_multisample.framebuffer(), timer);
            const auto pass = timer.pass("sample", gl::Phase::transparent);
            sample(number);
            m_by_depth ? accumulate() : add();
        }
        if (m_corrected) {
            const auto pass = timer.pass("transmittance", gl::Phase::transparent);
            Pass drawing = begin(m_transmittance_framebuffer);
            drawing.clear_color(glm::vec4(1));
            drawing.transparent_depth();
            drawing.blend(GL_ZERO, GL_ONE_MINUS_SRC_COLOR);
            m_scene.draw_transparent(m_alpha, Order::submission);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        composite();
    }

    void take_noise_of(int number) override { m_first_pass = static_cast<unsigned>(number * m_passes); }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        if (m_by_depth) return {};
        nlohmann::json samples = nlohmann::json::array();
        for (const Multisample::Sample& sample : m_multisample.read(trace.x(), trace.y())) {
            const std::optional<std::size_t> fragment =
                sample.color.a > 0 ? trace.at_depth(sample.depth) : std::nullopt;
            samples.push_back({{"fragment", fragment ? nlohmann::json(*fragment) : nlohmann::json()},
                               {"color", {sample.color.r, sample.color.g, sample.color.b}}});
        }
        return {{"samples", "samples", samples,
                 "The value of each sample of the last pass, and the fragment at its depth, or none and black if the "
                 "sample is not covered."}};
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_multisample, m_sum, m_transmittance); }

  private:
    static std::string prolog(const StochasticParameters& parameters) {
        return "#define SHEER_SAMPLES " + std::to_string(parameters.samples) + "\n#define SHEER_STRATIFIED " +
               (parameters.masks == StochasticParameters::Masks::stratified ? "1" : "0") +
               "\n#define SHEER_CORRECTED " + (parameters.alpha_correction ? "1" : "0") + "\n";
    }

    /// The samples have the depth of the opaque surfaces, but not their color.
    void sample(int number) const {
        Pass drawing = begin(m_multisample.framebuffer());
        drawing.clear_color(glm::vec4(0));
        drawing.depth_test(GL_LEQUAL);
        if (m_by_depth) drawing.no_color();
        m_sample.set("u_seed", m_seed * 65537u + m_first_pass + static_cast<unsigned>(number));
        m_scene.draw_transparent(m_sample, Order::submission);
    }

    void accumulate() const {
        Pass drawing = begin(m_sum_with_depth);
        drawing.transparent_depth();
        drawing.blend(GL_ONE, GL_ONE);
        m_accumulate.set_texture("u_depths", m_multisample.depth());
        m_scene.draw_transparent(m_accumulate, Order::submission);
    }

    void add() const {
        Pass drawing = begin(m_sum_framebuffer);
        drawing.blend(GL_ONE, GL_ONE);
        m_add.program().set_texture("u_samples", m_multisample.color());
        m_add.draw();
    }

    /// Reads the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, 9.3.1).
    void composite() const {
        const Pass drawing = begin();
        m_gl.TextureBarrier();
        m_composite.program().set_texture("u_opaque", m_target.color());
        m_composite.program().set_texture("u_sum", m_sum);
        if (m_corrected) m_composite.program().set_texture("u_transmittance", m_transmittance);
        m_composite.draw();
    }

    int m_passes;
    unsigned m_seed, m_first_pass = 0;
    bool m_corrected, m_by_depth;
    Multisample m_multisample;
    gl::Program m_sample, m_accumulate, m_alpha;
    FullscreenPass m_add, m_composite;
    gl::Texture m_sum, m_transmittance;
    gl::Framebuffer m_sum_framebuffer, m_sum_with_depth, m_transmittance_framebuffer;
};

}  // namespace

MethodInfo method_stochastic() {
    return describe_method(
        {
            .id = "stochastic",
            .name = "Stochastic transparency",
            .kind = "stochastic",
            .summary =
                "Each fragment covers a random part of the pixel's samples, as large as its alpha, as if opaque.",
            .paper = "Enderton, Sintorn, Shirley, Luebke, Stochastic Transparency, I3D 2010",
            .good_at =
                "The correct picture in the mean, for any order and for intersecting primitives, with only a depth "
                "test; the more samples, the less noise.",
            .bad_at = "Noise, which falls with the square root of the samples: for half of it, four times as many.",
            .memory =
                "16 bytes per pixel, and for each sample one pixel of the image format and 4 bytes of depth; 4 more "
                "per pixel with alpha_correction",
            .passes = "1 and a full-screen one for each of its passes, 2 with the variant depth; 1 more with "
                      "alpha_correction; a full-screen one at the end",
            .needs = "multisampling with sample masks; float targets",
            .needs_sorting = false,
        },
        StochasticParameters::table(), make_new<Stochastic>,
        [](const StochasticParameters& parameters, int pixel_bytes) -> std::optional<double> {
            return 16 + parameters.samples * (pixel_bytes + 4) + (parameters.alpha_correction ? 4 : 0);
        });
}

}  // namespace sheer
