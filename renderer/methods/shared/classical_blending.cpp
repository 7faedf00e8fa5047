#include "renderer/methods/shared/classical_blending.h"

#include <optional>

namespace sheer {

ClassicalBlending::ClassicalBlending(const MethodSetup& setup, Order order)
    : OpaqueFirst(setup),
      m_order(order),
      m_program(setup.scene.make_program("classical blending", gl::shader_file("methods/b2f.glsl"))) {}

void ClassicalBlending::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    std::optional<Pass> drawing;
    {
        const auto pass = timer.pass("state", gl::Phase::initialization);
        drawing.emplace(begin());
        drawing->transparent_depth();
        drawing->blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    {
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        m_scene.draw_transparent(m_program, m_order);
    }
    const auto pass = timer.pass("state", gl::Phase::finalization);
    drawing.reset();
}

std::vector<PixelFact> ClassicalBlending::explain(const PixelTrace& trace) const {
    return {fragments_fact("blended", trace.of(m_program).passed(),
                           "The fragments in the order in which they were blended, each over all before it.")};
}

}  // namespace sheer
