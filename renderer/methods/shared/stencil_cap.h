#pragma once
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/own_depth.h"

namespace sheer {

struct StencilCapParameters {
    int layers = 8;
    double min_alpha = 0.02;
    int frames = 30;
    bool zcull = false;

    static ParamTable<StencilCapParameters> table();
};

/// Front-to-back blending of at most `layers` fragments a pixel, over a blurred copy of the previous frame: "Drawing in
/// Reverse", 2007.
class StencilCap : public OpaqueFirst {
  public:
    StencilCap(const MethodSetup& setup, const StencilCapParameters& parameters);

    /// The first call renders frames 1 to `frames`; each later call renders the last of them again, from the same
    /// previous frame, so that the picture is always that of frame `frames` and the time that of one frame.
    void render(gl::FrameTimer& timer) override;
    void restart() override { m_frame = 0; }
    bool keeps_frames() const override { return true; }
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override;
    /// {"change_per_frame": [...]}
    nlohmann::json findings(gl::FrameTimer& timer) override;

    /// Restarts and renders `frames` frames. Returns `frames` - 1 numbers: the greatest change in red, green or blue of
    /// any pixel from one frame to the next.
    std::vector<double> change_per_frame(gl::FrameTimer& timer);

  private:
    /// Moves on to the next frame; the one drawn last becomes the previous one.
    void advance();
    void draw_frame(gl::FrameTimer& timer) const;
    void prime_depth() const;
    void draw_capped() const;
    void count_fragments() const;
    void fill() const;
    void set_fill_textures() const;
    void keep_picture() const;
    void make_counts(const MethodSetup& setup);
    gl::Texture history_texture() const;

    int m_layers;
    int m_frames;
    bool m_zcull;
    bool m_tests_alpha;
    bool m_counts;    ///< in a pass of its own; otherwise in the stencil
    int m_frame = 0;  ///< drawn last; 0 for none
    int m_coarse_width_px, m_coarse_height_px;
    Accumulation m_accumulation;
    OwnDepth m_depth;
    FullscreenPass m_fill;
    gl::Program m_program, m_coarse_program, m_prime, m_count_program;
    gl::Texture m_previous, m_current;
    gl::Texture m_coarse_depth, m_count;
    gl::Framebuffer m_coarse, m_count_framebuffer;
    gl::VertexArray m_no_vertices;
};

}  // namespace sheer
