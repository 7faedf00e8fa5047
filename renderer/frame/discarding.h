#pragma once
#include "renderer/frame/accumulation.h"
#include "renderer/methods/method.h"

namespace sheer {

/// Front-to-back blending in which a fragment reads the transmittance that is left and gives up where that is under a
/// threshold: SCCG 2010, sections 2.1 and 2.2. The parameters are those of `discarding_parameters()`.
class DiscardingBlending : public Method {
  public:
    /// `initial_transmittance` is 1 for F2BD and 0 for F2BX, which discards everything.
    /// Throws Unsupported for framebuffer_fetch where the driver lacks it.
    DiscardingBlending(const MethodSetup& setup, float initial_transmittance);
    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override { return m_accumulation.memory_bytes(); }

  private:
    enum class Sync { barrier, rebind, flush, finish, none };
    static Sync sync_named(const std::string& name);
    void synchronise() const;
    void draw_batches() const;

    const gl::Functions& m_gl;
    const Scene& m_scene;
    float m_initial_transmittance;
    float m_threshold;
    Sync m_sync;
    bool m_framebuffer_fetch;
    std::size_t m_batch;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    gl::Program m_program;
};

/// `threshold`, `sync`, `alpha_target`, `feedback`, `batch`, `form`, and those of alpha_form_parameters().
std::vector<Param> discarding_parameters();

}  // namespace sheer
