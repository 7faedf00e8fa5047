#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// A statement of a method about a pixel, for people and for programs.
struct PixelFact {
    std::string name;  ///< e.g. "alpha_sum"
    /// What `value` is: "number"; "color", red, green, blue; "fragment", a number from 1, near to far, or null for
    /// none; "fragments", an array of them; "samples", of each sample of the pixel {"fragment", "color"}.
    std::string kind;
    nlohmann::json value;
    std::string text;  ///< a sentence
};

PixelFact number_fact(const std::string& name, double value, const std::string& text);
PixelFact color_fact(const std::string& name, const glm::vec3& color, const std::string& text);
PixelFact fragment_fact(const std::string& name, std::optional<std::size_t> number, const std::string& text);
PixelFact fragments_fact(const std::string& name, const std::vector<std::size_t>& numbers, const std::string& text);

/// Follows the fragments of one pixel through a method's frame; the method needs no code for it.
///
/// While it observes a scene, transparent primitives are drawn only at that pixel, and those that have a fragment there
/// one by one, each in an occlusion query. That shows which fragments the method's own tests and discards let through.
/// The rest of the picture is not the method's. Nothing is recorded if the method has an occlusion query of its own or
/// draws several samples per pixel: llvmpipe's scissor lets samples of neighbours through, which the query counts.
class PixelTrace : public DrawObserver {
  public:
    /// What is under the pixel.
    struct Surface {
        std::uint32_t primitive = 0;
        double depth = 1;
        double alpha = 0;
    };
    struct Fragment {
        std::size_t number = 0;  ///< from 1, near to far, as in PixelStack::fragments
        bool passed = false;     ///< it passed every test and was not discarded
    };
    /// What one program did.
    struct Draws {
        std::vector<Fragment> fragments;  ///< in the order of drawing
        /// Color output 0 after the last of them; none if there is no color.
        std::optional<glm::vec4> color;

        std::vector<std::size_t> passed() const;  ///< numbers, in the order of drawing
        std::vector<std::size_t> failed() const;
        std::optional<std::size_t> last_passed() const;
    };

    /// Traces the pixel (x, y) of a picture of this size. `fragments` are those of the pixel, near to far; others are
    /// not recorded. Behind them is the opaque surface at `opaque_depth`, 1 for the background. Observes the scene
    /// until it is destroyed. All references outlive it.
    PixelTrace(const gl::Functions& gl, Scene& scene, glm::ivec2 size_px, glm::ivec2 pixel,
               std::vector<Surface> fragments, double opaque_depth);
    ~PixelTrace() override;
    PixelTrace(const PixelTrace&) = delete;
    PixelTrace& operator=(const PixelTrace&) = delete;

    int x() const { return m_pixel.x; }
    int y() const { return m_pixel.y; }
    /// Empty if `program` drew nothing there. Waits for the device.
    Draws of(const gl::Program& program) const;
    /// The alpha of the fragment with this number, before any method's own rounding.
    double alpha(std::size_t number) const { return m_fragments.at(number - 1).alpha; }
    /// The number of the fragment closest to this depth; none if the opaque surface is closest.
    std::optional<std::size_t> at_depth(double depth) const;

    void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) override;
    /// Nothing is recorded.
    void gather(const gl::Program& program) override { m_scene.gather_unobserved(program); }

  private:
    struct Step {
        std::size_t number;
        gl::Query query;
    };
    struct Record {
        std::vector<Step> steps;
        std::optional<glm::vec4> color;
    };
    void draw_steps(const gl::Program& program, Order order, std::size_t first, std::size_t count, Record& record);
    std::optional<glm::vec4> color_now(glm::ivec2 pixel) const;

    const gl::Functions& m_gl;
    Scene& m_scene;
    glm::ivec2 m_size_px, m_pixel;
    std::vector<Surface> m_fragments;
    double m_opaque_depth;
    std::unordered_map<std::uint32_t, std::size_t> m_numbers;  ///< of fragments, by primitive
    std::map<GLuint, Record> m_records;                        ///< by program
};

}  // namespace sheer
