#include "renderer/frame/classical_blending.h"

namespace sheer {

ClassicalBlending::ClassicalBlending(const MethodSetup& setup, Order order)
    : m_gl(setup.gl),
      m_scene(setup.scene),
      m_target(setup.target),
      m_order(order),
      m_opaque(setup.gl, setup.scene, setup.target),
      m_program(setup.scene.make_program("classical blending", gl::shader_file("methods/b2f.glsl"))) {}

void ClassicalBlending::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("state", gl::Phase::initialization);
        begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
        set_transparent_depth_state(m_gl);
        m_gl.Enable(GL_BLEND);
        m_gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    {
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        m_scene.draw_transparent(m_program, m_order);
    }
    const auto pass = timer.pass("state", gl::Phase::finalization);
    m_gl.Disable(GL_BLEND);
}

std::vector<PixelFact> ClassicalBlending::explain(const PixelTrace& trace) const {
    return {fragments_fact("blended", trace.of(m_program).passed(),
                           "The fragments in the order in which they were blended, each over all before it.")};
}

}  // namespace sheer
