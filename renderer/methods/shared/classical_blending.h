#pragma once
#include "renderer/methods/shared/method.h"

namespace sheer {

/// Classical blending, SRC_ALPHA over ONE_MINUS_SRC_ALPHA, straight into the target, in any order.
class ClassicalBlending : public OpaqueFirst {
  public:
    ClassicalBlending(const MethodSetup& setup, Order order);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;

  private:
    Order m_order;
    gl::Program m_program;
};

}  // namespace sheer
