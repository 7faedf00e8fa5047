#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/scene_info.h"
#include "renderer/scene/textures.h"

namespace sheer {

enum class Order { submission, near_to_far, far_to_near };

/// Intercepts the drawing of transparent primitives, for instance to count what methods shade.
class DrawObserver {
  public:
    virtual ~DrawObserver() = default;
    /// Replaces Scene::draw_transparent; draws with Scene::draw_unobserved.
    virtual void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) = 0;
    /// Replaces Scene::gather; draws with Scene::gather_unobserved.
    virtual void gather(const gl::Program& program) = 0;
};

/// A scene on the device: geometry in each order, textures, and the shading `real_work`.
///
/// In every order, of primitives with equal depth the one submitted later counts as nearer.
class Scene {
  public:
    /// `parameters` are the normalised ones of the spec, for shading and texture.
    /// `pointer` is where a spec has them, for errors of the user's own shading.
    Scene(const gl::Functions& gl, const Geometry& geometry, const nlohmann::json& parameters,
          const std::string& pointer = "/scene");

    bool parallel() const { return m_parallel; }
    std::size_t transparent_count() const { return m_transparent_count; }
    /// Triangles of `count` transparent primitives from the `first` in this order.
    std::size_t triangle_count(Order order, std::size_t first, std::size_t count) const;
    /// The number of the primitive, in the order of submission and opaque ones counted too, at `place` of this order.
    std::uint32_t primitive_at(Order order, std::size_t place) const { return list(order).primitives[place]; }
    bool has_opaque() const { return m_opaque_index_count > 0; }
    /// The screen rectangle of each primitive, by its number (primitive_at): left, top, right and bottom in fractions
    /// of the image, from its top left corner. It holds every fragment, and may reach beyond the image.
    const std::vector<glm::vec4>& screen_rects() const { return m_screen_rects; }

    /// The alpha from which on a fragment counts as having at least the alpha `reference`. It is `reference` itself if
    /// alphas reach the fragments as they were given; 2^-12 less if they are read from textures or interpolated, which
    /// rounds them. 2^-12 is half the spacing of half floats from 0.5 to 1 and a sixteenth of an 8-bit level.
    float least_alpha(double reference) const;

    /// A program that draws this scene: its vertex stage, `real_work(vec2 uv, vec4 tint)`, then `method_source` with
    /// main(). `prolog` comes right after #version: #extension and #define lines.
    /// main() sees what is in shaders/scenes/inputs.glsl; if it declares a uniform int u_first_triangle, this plus
    /// gl_PrimitiveID is a triangle's place in the order that is drawn, however many draws it is divided into.
    /// Throws SpecError at glsl_pointer() if the user's own shading does not compile.
    gl::Program make_program(std::string_view label, std::string_view method_source,
                             const std::string& prolog = {}) const;
    /// The same, but the primitives of which `skip_source`, GLSL of the vertex stage, says `bool sheer_skips(uint
    /// primitive)` are not drawn.
    gl::Program make_skipping_program(std::string_view label, std::string_view method_source,
                                      std::string_view skip_source, const std::string& prolog = {}) const;

    /// A program over the whole picture whose main() finds its fragments itself: it sets what
    /// shaders/scenes/inputs.glsl declares for it, then calls begin_fragment() and real_work(). Throws Unsupported if
    /// the shading takes derivatives.
    gl::Program make_gathering_program(std::string_view label, std::string_view method_source,
                                       const std::string& prolog) const;
    /// Draws with it over the whole of the current framebuffer.
    void gather(const gl::Program& program) const;
    void gather_unobserved(const gl::Program& program) const;
    /// Lets a program read the vertices, 32-bit words as in Vertex, at binding 0, the indices of the transparent
    /// triangles in this order at 1, and the texture coordinates of emission, if there are any, at 6.
    void bind_triangles(const gl::Program& program, Order order) const;
    bool has_emission_uvs() const { return static_cast<bool>(m_emission_uvs); }
    /// Texture reads of a fragment's shading, if they are the same for all.
    std::optional<int> reads_of_fragment() const { return m_reads_of_fragment; }
    /// Of all loops of the shading of one fragment together, the most iterations.
    int most_iterations() const { return m_most_iterations; }

    /// Whether the shading is the user's own and has loops, which count their iterations.
    /// (renderer/counting/loop_check.h.)
    bool counts_iterations() const { return m_counts_iterations; }
    /// Where a spec has the user's own shading of this scene.
    const std::string& glsl_pointer() const { return m_glsl_pointer; }
    /// While it is on, new programs set the first word of the storage buffer at loop_report_binding to 1 when an
    /// iteration is refused. They are not fit for timing.
    void report_loops(bool on) { m_reports_loops = on; }

    /// Draws with `program` (of make_program) in use; binds the vertex array and texture unit 0.
    void draw_opaque(const gl::Program& program) const;
    void draw_transparent(const gl::Program& program, Order order) const;
    /// `count` primitives from the `first` in this order.
    void draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) const;

    /// From now on `observer` draws the transparent primitives; with null, the scene itself does.
    void observe(DrawObserver* observer) { m_observer = observer; }
    void draw_unobserved(const gl::Program& program, Order order, std::size_t first, std::size_t count) const;

  private:
    struct DrawList {
        gl::Buffer indices;
        std::vector<std::size_t> first_index;   ///< of each primitive, and one past the last
        std::vector<std::uint32_t> primitives;  ///< their numbers
    };
    gl::Program build_program(std::string_view label, const std::string& vertex_source,
                              const std::string& shading_source, std::string_view method_source,
                              const std::string& prolog) const;
    DrawList make_list(const Geometry& geometry, const std::vector<std::size_t>& order, std::string_view label) const;
    void make_shading(const Geometry& geometry, const nlohmann::json& parameters);
    void add_own_shading(const Geometry& geometry, const nlohmann::json& parameters);
    void make_textures(const Geometry& geometry, const nlohmann::json& texture);
    void fill_painted_layer(GLint layer, const std::vector<TextureLevel>& levels) const;
    void make_materials(const Geometry& geometry);
    void make_pictures(const Geometry& geometry);
    void add_emission_uvs(const std::vector<glm::vec2>& uvs);
    gl::Texture make_repeating_array(std::string_view label) const;
    void fill_layer(const gl::Texture& texture, GLint layer, GLint first_level, const std::vector<Image>& levels) const;
    void bind(const gl::Program& program, const gl::Buffer& indices) const;
    void bind_shading(const gl::Program& program) const;
    const DrawList& list(Order order) const { return m_lists[static_cast<std::size_t>(order)]; }

    const gl::Functions& m_gl;
    DrawObserver* m_observer = nullptr;
    bool m_parallel;
    bool m_flat_tint;       ///< every triangle has one tint
    bool m_alpha_is_given;  ///< and all its fragments have its alpha
    glm::mat4 m_view_projection;
    std::string m_glsl_pointer;
    std::string m_vertex_source;
    std::string m_shading_source;  ///< GLSL with inputs and real_work
    bool m_counts_iterations = false, m_reports_loops = false, m_takes_derivatives = false;
    int m_most_iterations = 0;
    std::size_t m_transparent_count = 0;
    std::vector<glm::vec4> m_screen_rects;
    GLsizei m_opaque_index_count = 0;
    gl::Buffer m_vertices;
    gl::VertexArray m_vertex_array, m_no_attributes;
    DrawList m_opaque;
    DrawList m_lists[3];  ///< by Order
    int m_reads = 0;
    std::optional<int> m_reads_of_fragment;
    gl::Texture m_textures;  ///< an array of four
    VolumeTextures m_volume;
    gl::Buffer m_materials;  ///< of a model, and their pictures as arrays
    std::vector<gl::Texture> m_pictures;
    gl::Buffer m_emission_uvs;
};

inline constexpr GLuint loop_report_binding = 7;

/// Begins every fragment shader.
inline constexpr const char* glsl_version = "#version 450 core\n";

}  // namespace sheer
