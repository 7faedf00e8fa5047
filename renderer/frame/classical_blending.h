#pragma once
#include "renderer/methods/method.h"

namespace sheer {

/// Classical blending, SRC_ALPHA over ONE_MINUS_SRC_ALPHA, straight into the target, in any order.
class ClassicalBlending : public Method {
  public:
    ClassicalBlending(const MethodSetup& setup, Order order);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;

  private:
    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    Order m_order;
    OpaquePass m_opaque;
    gl::Program m_program;
};

}  // namespace sheer
