#pragma once
#include <map>
#include <optional>
#include <string>

#include "renderer/frame/count_image.h"
#include "renderer/frame/target.h"

namespace sheer {

/// Counts, pixel by pixel, how often a method shades a transparent fragment, without the method knowing of it.
///
/// While it observes a scene, each program that draws transparent primitives is replaced by a variant in which every
/// call of real_work adds 1 to its pixel. Which fragments get that far must stay as it is, though a shader that writes
/// to memory loses the early depth test unless it asks for it:
/// - If the program writes depth, its tests come last in any case; the variant leaves them there.
/// - If it cannot discard, or if nothing but colour is written, the variant asks for early tests: they decide the same.
/// - Else (discard, with depth or stencil written) each primitive is drawn twice: first by the variant with early tests
///   and nothing else written, then by the program itself. The triangles of one primitive must not overlap.
class ShadingCounter : public DrawObserver {
  public:
    /// Observes the scene until it is destroyed. All references outlive it; programs that draw must, too.
    ShadingCounter(const gl::Functions& gl, Scene& scene, const Target& target);
    ~ShadingCounter() override;
    ShadingCounter(const ShadingCounter&) = delete;
    ShadingCounter& operator=(const ShadingCounter&) = delete;

    void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) override;

    struct Count {
        std::optional<PixelCounts> shaded;
        std::string reason;  ///< why it could not be told
    };
    /// What has been drawn since it was made. Waits for the device.
    Count read() const;

  private:
    struct Variant {
        gl::Program program;
        bool tests_as_before;  ///< whether fragments fare as in the original, whatever the state
    };
    Variant& variant_of(const gl::Program& program);
    void prepare(const gl::Program& original, const gl::Program& variant) const;
    void draw_twice(const gl::Program& program, const gl::Program& variant, Order order, std::size_t first,
                    std::size_t count) const;

    const gl::Functions& m_gl;
    Scene& m_scene;
    CountImage m_image;
    std::map<GLuint, Variant> m_variants;  ///< by the original's id
    std::string m_reason;
};

}  // namespace sheer
