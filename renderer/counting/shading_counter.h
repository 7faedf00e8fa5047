#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "renderer/counting/count_image.h"
#include "renderer/counting/early_tests.h"
#include "renderer/counting/warp_counter.h"
#include "renderer/passes/target.h"

namespace sheer {

/// How often a method shades a transparent fragment, for each pixel.
struct ShadingCount {
    /// Calls of the scene's shading on this device. What this counts depends on when the device tests depth and
    /// stencil; `shaded_by` says how that is known: "no_test_fails" (it makes no difference), "specified" (the shader
    /// asks for early tests, or writes depth or memory, which puts them off), "probed" (see EarlyTests).
    std::optional<PixelCounts> shaded;
    std::string no_shaded_reason;
    std::string shaded_by;
    /// Of these, the fragments that the tests let through: what is shaded at least, on any device.
    std::optional<PixelCounts> visible;
    std::string no_visible_reason;
    /// On a device that tests early where it may.
    std::optional<WarpCounts> warps;
    std::string no_warps_reason;
};

/// Counts how often a method shades a transparent fragment; the method needs no code for it.
///
/// While it observes a scene, each program that draws transparent primitives is replaced by a variant in which every
/// call of real_work adds 1 to its pixel. A shader that writes to memory is tested after it has run unless it asks for
/// early tests. So a frame is counted twice: once with late tests, which counts all fragments of the primitives, and
/// once with early tests, which counts only those that pass. If the two numbers differ, EarlyTests finds out which of
/// them is true of the device. The picture must stay the same in both:
/// - Late tests are what OpenGL says of any shader that does not ask for early ones.
/// - Early tests give the same result if the shader cannot discard, or if only color is written. Otherwise each
///   primitive is drawn twice: first by the variant with early tests and all other writes off, then by the program
///   itself. The triangles of one primitive must not overlap.
class ShadingCounter : public DrawObserver {
  public:
    /// Observes the scene until it is destroyed. All references must outlive it, and so must programs that draw.
    ShadingCounter(const gl::Functions& gl, Scene& scene, const Target& target);
    ~ShadingCounter() override;
    ShadingCounter(const ShadingCounter&) = delete;
    ShadingCounter& operator=(const ShadingCounter&) = delete;

    /// Frames are drawn with late tests at first. Then one must be drawn with early tests for each window, in order.
    std::size_t windows() const { return std::max<std::size_t>(m_warps.windows(), 1); }
    void test_early(std::size_t window);
    void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) override;
    void gather(const gl::Program& program) override;

    /// Waits for the device.
    ShadingCount read(EarlyTests& early_tests);

  private:
    /// When a program's fragments are tested according to OpenGL.
    enum class Specified { nowhere, early, late };
    struct Variants {
        gl::Program late, early;
        Specified specified = Specified::nowhere;
        DrawKind shader;  ///< the shader's part of it
    };
    struct Tally {
        CountImage late, early;
        std::string no_early_reason;
    };
    using Key = std::pair<Specified, DrawKind>;

    const Variants& variants_of(const gl::Program& program);
    Tally& tally_of(const Key& key);
    void prepare(const gl::Program& original, const gl::Program& variant, const CountImage& image) const;
    void prepare_early(const gl::Program& original, const gl::Program& variant, const CountImage& image) const;
    void draw_late(const gl::Program& program, Order order, std::size_t first, std::size_t count);
    void draw_early(const gl::Program& program, Order order, std::size_t first, std::size_t count);
    void draw_twice(const gl::Program& program, const gl::Program& variant, Order order, std::size_t first,
                    std::size_t count) const;

    const gl::Functions& m_gl;
    Scene& m_scene;
    int m_width_px, m_height_px;
    bool m_early = false;
    std::size_t m_window = 0;
    WarpCounter m_warps;
    std::string m_no_warps_reason;
    CountImage m_counted;                   ///< of fragments that have been counted before
    std::map<GLuint, Variants> m_variants;  ///< by the original's id
    std::map<Key, Tally> m_tallies;
};

/// Counts what `render_frame` draws of the scene; it is called at least twice.
ShadingCount count_shaded(const gl::Functions& gl, Scene& scene, const Target& target, EarlyTests& early_tests,
                          const std::function<void()>& render_frame);

}  // namespace sheer
