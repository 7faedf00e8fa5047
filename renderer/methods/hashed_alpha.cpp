// Hashed alpha testing: Wyman and McGuire, Hashed Alpha Testing, I3D 2017. The threshold of the alpha test is a hash of
// the fragment's place on the object, so that as many pixels show a surface as its alpha says, and the grain neither
// swims nor changes from frame to frame. Everything is drawn as if it were opaque.
// The hash is an integer one instead of the paper's sine, which differs from device to device. The paper's hash of the
// place alone gives layers in one grain the same threshold, so that the nearer one hides the farther one completely.
#include "renderer/methods/shared/method.h"
#include "renderer/passes/frame_mean.h"

#include <optional>

namespace sheer {

namespace {

struct HashedAlphaParameters {
    enum class Hash { position, position_and_primitive };

    double hash_scale = 1;
    Hash hash = Hash::position;
    int frames = 1;
    std::int64_t seed = 0;

    static ParamTable<HashedAlphaParameters> table() {
        return ParamTable<HashedAlphaParameters>()
            .number(&HashedAlphaParameters::hash_scale, "hash_scale", "the size of a grain of the pattern", "pixels",
                    0.1, 100)
            .choice(&HashedAlphaParameters::hash, "hash",
                    "what a threshold depends on: the place on the object, as in the paper, or also the primitive, so "
                    "that layers close to each other are independent",
                    {{"position", Hash::position}, {"position_and_primitive", Hash::position_and_primitive}})
            .integer(&HashedAlphaParameters::frames, "frames",
                     "frames of different thresholds whose mean is shown, as temporal antialiasing would", "frames", 1,
                     65536)
            .integer(&HashedAlphaParameters::seed, "seed", "other numbers give other thresholds", "", 0, 1000000);
    }
};

class HashedAlpha : public OpaqueFirst {
  public:
    HashedAlpha(const MethodSetup& setup, const HashedAlphaParameters& parameters)
        : OpaqueFirst(setup),
          m_frames(parameters.frames),
          m_seed(static_cast<unsigned>(parameters.seed)),
          m_program(setup.scene.make_program(
              "hashed alpha", gl::shader_file("common/hash.glsl") + gl::shader_file("methods/hashed_alpha.glsl"))) {
        m_program.set("u_hash_scale", static_cast<float>(parameters.hash_scale));
        m_program.set("u_hashes_primitive", parameters.hash == HashedAlphaParameters::Hash::position ? 0 : 1);
        if (m_frames > 1) m_mean.emplace(setup.gl, setup.target);
    }

    /// Over several frames, a mean that moves on by one. A single one keeps its thresholds, as in the paper.
    void take_noise_of(int number) override { m_first = m_mean ? static_cast<unsigned>(number) : 0; }

    void render(gl::FrameTimer& timer) override {
        if (!m_mean) return draw(timer, 0);
        m_mean->clear();
        for (int frame = 0; frame < m_frames; ++frame) {
            draw(timer, frame);
            const auto pass = timer.pass("add", gl::Phase::finalization);
            m_mean->add();
        }
        const auto pass = timer.pass("mean", gl::Phase::finalization);
        m_mean->write(m_frames);
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        if (m_mean) return {};
        const PixelTrace::Draws draws = trace.of(m_program);
        return {fragments_fact("drawn", draws.passed(), "The fragments with at least the alpha of their threshold."),
                fragment_fact("shown", draws.last_passed(), "The nearest of them; none if the opaque surface shows.")};
    }

    std::int64_t memory_bytes() const override { return m_mean ? m_mean->memory_bytes() : 0; }

  private:
    void draw(gl::FrameTimer& timer, int frame) const {
        m_opaque.draw(timer);
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        Pass drawing = begin();
        drawing.depth_test(GL_LEQUAL);
        m_program.set("u_seed", m_seed + m_first + static_cast<unsigned>(frame));
        m_scene.draw_transparent(m_program, Order::submission);
    }

    int m_frames;
    unsigned m_seed, m_first = 0;
    gl::Program m_program;
    std::optional<FrameMean> m_mean;
};

}  // namespace

MethodInfo method_hashed_alpha() {
    return describe_method(
        {
            .id = "hashed_alpha",
            .name = "Hashed alpha testing",
            .kind = "stochastic",
            .summary = "An alpha test against a hash of the place on the object: as many pixels show a surface as its "
                       "alpha says.",
            .paper = "Wyman and McGuire, Hashed Alpha Testing, I3D 2017",
            .good_at = "Needs no sorting, no blending and no memory; distant foliage keeps its density.",
            .bad_at = "Visible grain; with the paper's hash, layers in one grain hide each other completely.",
            .memory = "0 bytes per pixel; 16 for several frames",
            .passes = "1 for each of its frames",
            .needs_sorting = false,
        },
        HashedAlphaParameters::table(), make_new<HashedAlpha>,
        [](const HashedAlphaParameters& parameters, int) -> std::optional<double> {
            return parameters.frames > 1 ? 16 : 0;
        });
}

}  // namespace sheer
