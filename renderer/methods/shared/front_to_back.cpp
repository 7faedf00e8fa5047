#include "renderer/methods/shared/front_to_back.h"

namespace sheer {

FrontToBack::FrontToBack(const MethodSetup& setup, const AlphaForm& form)
    : OpaqueFirst(setup),
      m_accumulation(setup.gl, setup.target, setup.target.format(), false, form),
      m_program(setup.scene.make_program("front to back", gl::shader_file("methods/f2b.glsl"), form.prolog())) {}

void FrontToBack::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("clear", gl::Phase::initialization);
        m_accumulation.clear(1);
    }
    {
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        const Pass drawing = m_accumulation.blending();
        m_scene.draw_transparent(m_program, Order::near_to_far);
    }
    const auto pass = timer.pass("composite", gl::Phase::finalization);
    m_accumulation.composite();
}

std::vector<PixelFact> FrontToBack::explain(const PixelTrace& trace) const {
    const PixelTrace::Draws draws = trace.of(m_program);
    std::vector<PixelFact> facts = {fragments_fact("blended", draws.passed(),
                                                   "The fragments in the order in which they were blended, each behind "
                                                   "all before it.")};
    add_accumulated(facts, draws.color, m_accumulation.form());
    return facts;
}

}  // namespace sheer
