#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "renderer/frame/count_image.h"
#include "renderer/frame/early_tests.h"
#include "renderer/frame/target.h"

namespace sheer {

/// How often a method shades a transparent fragment, pixel by pixel.
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
};

/// Counts how often a method shades a transparent fragment, without the method knowing of it.
///
/// While it observes a scene, each program that draws transparent primitives is replaced by a variant in which every
/// call of real_work adds 1 to its pixel. A shader that writes to memory is tested after it has run unless it asks for
/// early tests, so that a frame is counted twice: once with late tests, where all fragments of the primitives are
/// counted, and once with early ones, where only those are that pass. Which of the two numbers tells what ran, the
/// device is asked where they differ (EarlyTests). The picture must stay as it is in both:
/// - Late tests are what OpenGL says of any shader that does not ask for early ones.
/// - Early tests decide the same if the shader cannot discard, or if nothing but colour is written. Else each primitive
///   is drawn twice: first by the variant with early tests and nothing else written, then by the program itself. The
///   triangles of one primitive must not overlap.
class ShadingCounter : public DrawObserver {
  public:
    /// Observes the scene until it is destroyed. All references outlive it; programs that draw must, too.
    ShadingCounter(const gl::Functions& gl, Scene& scene, const Target& target);
    ~ShadingCounter() override;
    ShadingCounter(const ShadingCounter&) = delete;
    ShadingCounter& operator=(const ShadingCounter&) = delete;

    /// Of the frames that are drawn from now on; at first late. To be read, frames must be drawn with each.
    void test_early(bool early) { m_early = early; }
    void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) override;

    /// Waits for the device.
    ShadingCount read(EarlyTests& early_tests) const;

  private:
    /// When OpenGL itself says that a program's fragments are tested.
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
    void draw_late(const gl::Program& program, Order order, std::size_t first, std::size_t count);
    void draw_early(const gl::Program& program, Order order, std::size_t first, std::size_t count);
    void draw_twice(const gl::Program& program, const gl::Program& variant, Order order, std::size_t first,
                    std::size_t count) const;

    const gl::Functions& m_gl;
    Scene& m_scene;
    int m_width_px, m_height_px;
    bool m_early = false;
    std::map<GLuint, Variants> m_variants;  ///< by the original's id
    std::map<Key, Tally> m_tallies;
};

/// Counts what `render_frame` draws of the scene; it is called twice.
ShadingCount count_shaded(const gl::Functions& gl, Scene& scene, const Target& target, EarlyTests& early_tests,
                          const std::function<void()>& render_frame);

}  // namespace sheer
