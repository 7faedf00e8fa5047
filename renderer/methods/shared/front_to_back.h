#pragma once
#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"

namespace sheer {

/// Premultiplied blending from near to far into an accumulation of the target's format, laid over the opaque picture at
/// the end: SCCG 2010, section 2.
class FrontToBack : public OpaqueFirst {
  public:
    FrontToBack(const MethodSetup& setup, const AlphaForm& form);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    Accumulation m_accumulation;
    gl::Program m_program;
};

}  // namespace sheer
