// Classical blending at half the opacity.
#include "renderer/methods/shared/method.h"

namespace sheer {
namespace {

struct MadeUpParameters {
    double whim = 0.25;

    static ParamTable<MadeUpParameters> table() {
        return ParamTable<MadeUpParameters>().number(&MadeUpParameters::whim, "whim", "changes nothing", "", 0, 1);
    }
};

class MadeUpMethod : public OpaqueFirst {
  public:
    MadeUpMethod(const MethodSetup& setup, const MadeUpParameters&)
        : OpaqueFirst(setup),
          m_program(setup.scene.make_program("made up", gl::shader_file("methods/made_up_method.glsl"))) {}

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        const auto timed = timer.pass("transparent", gl::Phase::transparent);
        Pass pass = begin();
        pass.transparent_depth();
        pass.blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        m_scene.draw_transparent(m_program, Order::far_to_near);
    }

  private:
    gl::Program m_program;
};

}  // namespace

MethodInfo method_made_up_method() {
    return describe_method(
        {
            .id = "made_up_method",
            .name = "Made-up method",
            .kind = "sorted blending",
            .summary = "Classical blending at half the opacity.",
            .paper = "Made up",
            .good_at = "Being found wherever methods are.",
            .bad_at = "Everything else.",
            .memory = "0 bytes per pixel",
            .passes = "1",
        },
        MadeUpParameters::table(), make_new<MadeUpMethod>, pixels_and_bytes(0));
}

}  // namespace sheer
