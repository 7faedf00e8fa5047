#pragma once
#include "renderer/frame/accumulation.h"
#include "renderer/methods/method.h"

namespace sheer {

/// Premultiplied blending from near to far into an accumulation of the target's format, laid over the opaque picture at
/// the end: SCCG 2010, section 2. The parameters are those of alpha_form_parameters().
class FrontToBack : public Method {
  public:
    explicit FrontToBack(const MethodSetup& setup);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    const Scene& m_scene;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    gl::Program m_program;
};

}  // namespace sheer
