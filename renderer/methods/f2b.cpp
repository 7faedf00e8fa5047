// Front-to-back blending: F2B of Vlcek, Havel, Herout, SCCG 2010, section 2, equations (3) to (5).
// The transparent primitives are drawn from near to far into an RGBA texture that starts at (0, 0, 0, 1), with
// premultiplied colour and inverted alpha; the texture is then laid over the opaque picture.
// Good at: the picture of B2F, ready for discarding. Bad at: an extra texture, a clear and a full-screen pass.
// No parameters.
#include "renderer/frame/accumulation.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

class FrontToBack : public Method {
  public:
    explicit FrontToBack(const MethodSetup& setup)
        : m_scene(setup.scene),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, setup.target.format()),
          m_program(setup.scene.make_program("f2b", gl::shader_file("methods/f2b.glsl"))) {}

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_accumulation.clear(1);
        }
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            m_accumulation.begin_blending();
            m_scene.draw_transparent(m_program, Order::near_to_far);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_accumulation.composite();
    }

    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    const Scene& m_scene;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    gl::Program m_program;
};

}  // namespace

MethodInfo method_f2b() {
    return {
        .id = "f2b",
        .name = "F2B",
        .kind = "sorted blending",
        .summary = "Premultiplied blending from near to far into a texture, laid over the opaque picture at the end.",
        .paper = "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 2",
        .good_at = "The same picture as B2F; cheaper blend factors; the base of every early-discard method.",
        .bad_at = "One more texture, a clear and a full-screen pass, which do not pay below about 16 quads.",
        .memory = "one pixel of the image format",
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<FrontToBack>(setup);
        },
    };
}

}  // namespace sheer
