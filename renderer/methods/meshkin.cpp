// Sort-independent blending: Meshkin, Sort-Independent Alpha Blending (GDC 2007). The blended color of n layers over
// D, multiplied out, has a part that does not depend on the order of the layers; the rest is left out. With the sums
// S = sum A_i C_i and A = sum A_i, which are blended additively in any order:
//   simple: D + S - D A                                                        (slide 20; exact for one layer)
//   full:   D + S - D A - D (sum 1/A_i)(prod A_i) + D (prod A_i)                (slides 28 to 34)
// `full` is the whole order-independent part for four layers, for which the slides derive it; for one or two layers it
// is wrong: one layer gives A C, with no part of D. If no fragment has an alpha above 0, D stays.
// Sums are kept in 16-bit floats as on slide 28, or in 32-bit ones if the image is; only the result is clamped. The
// reciprocals and the product are always in 32-bit floats: in 16 bits 1/A_i could not exceed 65,504, so a single alpha
// below 1/65504 would overflow it, and the product would lose its digits. The omitted terms matter from alphas of about
// 0.3 on: up to 3 D for four layers of alpha 1 (slide 21).
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

struct MeshkinParameters {
    enum class Variant { simple, full };

    Variant variant = Variant::simple;

    static ParamTable<MeshkinParameters> table() {
        return ParamTable<MeshkinParameters>().choice(
            &MeshkinParameters::variant, "variant",
            "simple: D + S - D A; full: also the terms with the reciprocals and the product of the alphas, which need "
            "one more target and one more pass",
            {{"simple", Variant::simple}, {"full", Variant::full}});
    }
};

class Meshkin : public OpaqueFirst {
  public:
    Meshkin(const MethodSetup& setup, const MeshkinParameters& parameters)
        : OpaqueFirst(setup),
          m_full(parameters.variant == MeshkinParameters::Variant::full),
          m_accumulate(setup.scene.make_program("meshkin: accumulate",
                                                gl::shader_file("methods/meshkin_accumulate.glsl"), prolog())),
          m_composite(setup.gl, "meshkin: composite", gl::shader_file("methods/meshkin_composite.glsl"), prolog()),
          m_sums(texture("sums", m_target.format() == PixelFormat::rgba32f ? GL_RGBA32F : GL_RGBA16F)) {
        const GLuint depth = m_target.depth().id();
        if (!m_full) {
            m_framebuffer = gl::make_framebuffer(m_gl, "meshkin: sums", std::array{m_sums.id()}, depth);
            return;
        }
        m_reciprocals = texture("reciprocals", GL_R32F);
        m_products = texture("products", GL_R32F);
        m_framebuffer = gl::make_framebuffer(m_gl, "meshkin: sums", std::array{m_sums.id(), m_reciprocals.id()}, depth);
        m_product_framebuffer = gl::make_framebuffer(m_gl, "meshkin: products", std::array{m_products.id()}, depth);
        m_multiply = setup.scene.make_program("meshkin: multiply", gl::shader_file("methods/meshkin_multiply.glsl"));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            clear();
        }
        {
            const auto pass = timer.pass("accumulate", gl::Phase::transparent);
            const Pass drawing = blending(m_framebuffer, GL_ONE, GL_ONE);
            m_scene.draw_transparent(m_accumulate, Order::submission);
        }
        if (m_full) {
            const auto pass = timer.pass("multiply", gl::Phase::transparent);
            const Pass drawing = blending(m_product_framebuffer, GL_ZERO, GL_SRC_COLOR);
            m_scene.draw_transparent(m_multiply, Order::submission);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        composite();
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_sums, m_reciprocals, m_products); }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const int x = trace.x(), y = trace.y();
        const glm::vec4 sums = read_texel(m_gl, m_sums, x, y);
        std::vector<PixelFact> facts = {
            color_fact("color_sum", glm::vec3(sums), "S, the sum over all fragments of alpha times color."),
            number_fact("alpha_sum", sums.a, "A, the sum of the alphas.")};
        if (m_full) {
            facts.push_back(number_fact("alpha_product", read_texel(m_gl, m_products, x, y).r,
                                        "P, the product of the alphas that are not 0."));
            facts.push_back(number_fact("reciprocal_sum", read_texel(m_gl, m_reciprocals, x, y).r,
                                        "R, the sum of one over each alpha that is not 0."));
        }
        set_textures();
        const bool is_empty = m_full ? read_texel(m_gl, m_reciprocals, x, y).r == 0 : sums.a == 0;
        const double weight = is_empty ? 1 : shade_texel(m_gl, m_composite, m_target, x, y, 1).r;
        facts.push_back(number_fact("opaque_weight", weight,
                                    m_full ? "The weight of the opaque color, which is added to S: 1 - A + P - R P."
                                           : "The weight of the opaque color, which is added to S: 1 - A."));
        return facts;
    }

  private:
    std::string prolog() const { return std::string("#define SHEER_FULL ") + (m_full ? "1" : "0") + "\n"; }

    gl::Texture texture(const std::string& what, GLenum format) const {
        return m_target.make_texture("meshkin: " + what, format);
    }

    void clear() const {
        {
            const Pass clearing = begin(m_framebuffer);
            clearing.clear_color(glm::vec4(0));
            if (m_full) clearing.clear_color(glm::vec4(0), 1);
        }
        if (m_full) begin(m_product_framebuffer).clear_color(glm::vec4(1));
    }

    Pass blending(const gl::Framebuffer& framebuffer, GLenum source_factor, GLenum target_factor) const {
        Pass drawing = begin(framebuffer);
        drawing.transparent_depth();
        drawing.blend(source_factor, target_factor);
        return drawing;
    }

    /// Reads D from the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, 9.3.1).
    void composite() const {
        const Pass drawing = begin();
        m_gl.TextureBarrier();
        set_textures();
        m_composite.draw();
    }

    void set_textures() const {
        const gl::Program& program = m_composite.program();
        program.set_texture("u_opaque", m_target.color());
        program.set_texture("u_sums", m_sums);
        if (!m_full) return;
        program.set_texture("u_reciprocals", m_reciprocals);
        program.set_texture("u_products", m_products);
    }

    bool m_full;
    gl::Program m_accumulate, m_multiply;
    FullscreenPass m_composite;
    gl::Texture m_sums, m_reciprocals, m_products;
    gl::Framebuffer m_framebuffer, m_product_framebuffer;
};

}  // namespace

MethodInfo method_meshkin() {
    return describe_method(
        {
            .id = "meshkin",
            .name = "Meshkin",
            .kind = "order-independent, approximate",
            .summary =
                "Additive sums in any order; the part of the blended color that depends on the order is left out.",
            .paper = "Meshkin, Sort-Independent Alpha Blending, GDC 2007",
            .good_at = "Many faint layers without sorting; the simple variant is exact for one layer.",
            .bad_at =
                "Alphas over about 0.3: four layers of alpha 1 are off by up to three times the background. The full "
                "variant is derived for four layers and wrong for one or two: one layer loses the background.",
            .memory = "8 bytes per pixel, 16 with rgba32f; 8 more in the full variant",
            .passes = "1, or 2 in the full variant, and a full-screen one",
            .needs = "float targets with blending",
            .needs_sorting = false,
        },
        MeshkinParameters::table(), make_new<Meshkin>,
        [](const MeshkinParameters& parameters, int pixel_bytes) -> std::optional<double> {
            return (pixel_bytes == 16 ? 16 : 8) + (parameters.variant == MeshkinParameters::Variant::full ? 8 : 0);
        });
}

}  // namespace sheer
