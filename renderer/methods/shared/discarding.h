#pragma once
#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"

namespace sheer {

struct DiscardingParameters : AlphaForm {
    enum class Sync { barrier, rebind, flush, finish, none };
    enum class AlphaTarget { shared, separate };
    enum class Feedback { texture, framebuffer_fetch };
    enum class Form { if_else, if_discard };

    double threshold = 0.01;
    Sync sync = Sync::barrier;
    AlphaTarget alpha_target = AlphaTarget::shared;
    Feedback feedback = Feedback::texture;
    std::size_t batch = 0;
    Form form = Form::if_else;

    static ParamTable<DiscardingParameters> table();
};

/// See MethodInfo::bytes_per_px.
std::optional<double> discarding_bytes_per_px(const DiscardingParameters& parameters, int pixel_bytes);

/// Front-to-back blending in which a fragment reads the remaining transmittance and is discarded if that is under a
/// threshold: SCCG 2010, sections 2.1 and 2.2.
class DiscardingBlending : public OpaqueFirst {
  public:
    /// `initial_transmittance` is 1 for F2BD and 0 for F2BX, which discards everything.
    /// Throws Unsupported for framebuffer_fetch if the driver lacks it.
    DiscardingBlending(const MethodSetup& setup, const DiscardingParameters& parameters, float initial_transmittance);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    void synchronise() const;
    void draw_batches() const;

    DiscardingParameters m_parameters;
    float m_initial_transmittance;
    Accumulation m_accumulation;
    gl::Program m_program;
};

}  // namespace sheer
