#pragma once
#include <array>

#include "renderer/frame/accumulation.h"
#include "renderer/frame/own_depth.h"
#include "renderer/methods/method.h"

namespace sheer {

/// Front-to-back blending of at most `layers` fragments a pixel, over a blurred copy of the previous frame: "Drawing in
/// Reverse", 2007. The parameters are those of `stencil_cap_parameters()`.
class StencilCap : public Method {
  public:
    explicit StencilCap(const MethodSetup& setup);

    /// The first call renders the frames 1 to `frames`; each later one renders the last of them again, from the same
    /// previous frame, so that the picture is always that of frame `frames` and the time that of one frame.
    void render(gl::FrameTimer& timer) override;
    void restart() override { m_frame = 0; }
    bool keeps_frames() const override { return true; }
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override;
    /// {"change_per_frame": [...]}
    nlohmann::json findings(gl::FrameTimer& timer) override;

    /// Starts anew and renders `frames` frames. Returns `frames` - 1 numbers: by how much red, green or blue of any
    /// pixel changed at most from one frame to the next.
    std::vector<double> change_per_frame(gl::FrameTimer& timer);

  private:
    /// Goes on to the next frame, the one drawn last being the previous.
    void advance();
    void draw_frame(gl::FrameTimer& timer) const;
    void prime_depth() const;
    void draw_capped() const;
    void count_fragments() const;
    void fill() const;
    void bind_fill() const;
    void keep_picture() const;
    void make_counts(const MethodSetup& setup);
    gl::Texture history_texture() const;

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    int m_layers;
    int m_frames;
    bool m_zcull;
    bool m_tests_alpha;
    bool m_counts;    ///< in a pass of its own; else in the stencil
    int m_frame = 0;  ///< that was drawn last; 0 is none
    int m_coarse_width_px, m_coarse_height_px;
    OpaquePass m_opaque;
    Accumulation m_accumulation;
    OwnDepth m_depth;
    FullscreenPass m_fill;
    gl::Program m_program, m_coarse_program, m_prime, m_count_program;
    gl::Texture m_previous, m_current;
    gl::Texture m_coarse_depth, m_count;
    gl::Framebuffer m_coarse, m_count_framebuffer;
    gl::VertexArray m_no_vertices;
};

/// `layers`, `min_alpha`, `frames`, `zcull`.
std::vector<Param> stencil_cap_parameters();

}  // namespace sheer
