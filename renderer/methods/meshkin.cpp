// Sort-independent blending: Meshkin, Sort-Independent Alpha Blending (GDC 2007). The blended colour of n layers over
// D, multiplied out, has a part that does not depend on the order of the layers; the rest is left out. With the sums S
// = sum A_i C_i and A = sum A_i, which are blended additively in any order:
//   simple: D + S - D A                                                        (slide 20; exact for one layer)
//   full:   D + S - D A - D (sum 1/A_i)(prod A_i) + D (prod A_i)                (slides 28 to 34)
// `full` is the whole order-independent part for four layers, for which the slides derive it; for one or two layers it
// is wrong: one layer gives A C, without anything of D. Where no fragment has an alpha above 0, D stays.
// Sums are kept in 16-bit floats as on slide 28, in 32-bit ones where the image is; only the result is clamped. The
// reciprocals and the product are in 32-bit floats always: in 16 bits 1/A_i would end at 65,504, which an alpha under
// 1/65504 passes by itself, and the product would lose its digits.
// Good at: many faint layers, such as smoke, without sorting. Bad at: alphas over about 0.3, where the terms left out
// matter: up to 3 D for four layers of alpha 1 (slide 21). Parameters: `variant` simple or full, simple.
#include <array>

#include "renderer/frame/texel.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

constexpr GLuint unit_opaque = first_method_texture_unit, unit_sums = unit_opaque + 1,
                 unit_reciprocals = unit_opaque + 2, unit_products = unit_opaque + 3;

class Meshkin : public Method {
  public:
    explicit Meshkin(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_full(setup.parameters.at("variant") == "full"),
          m_in_32_bits(setup.target.format() == PixelFormat::rgba32f),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulate(setup.scene.make_program("meshkin: accumulate",
                                                gl::shader_file("methods/meshkin_accumulate.glsl"), prolog())),
          m_composite(setup.gl, "meshkin: composite", gl::shader_file("methods/meshkin_composite.glsl"), prolog()),
          m_sums(texture("sums", m_in_32_bits ? GL_RGBA32F : GL_RGBA16F)) {
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
            begin_blending(m_framebuffer, GL_ONE, GL_ONE);
            m_scene.draw_transparent(m_accumulate, Order::submission);
        }
        if (m_full) {
            const auto pass = timer.pass("multiply", gl::Phase::transparent);
            begin_blending(m_product_framebuffer, GL_ZERO, GL_SRC_COLOR);
            m_scene.draw_transparent(m_multiply, Order::submission);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        composite();
    }

    std::int64_t memory_bytes() const override {
        const std::int64_t pixels = std::int64_t{m_target.width_px()} * m_target.height_px();
        return pixels * ((m_in_32_bits ? 16 : 8) + (m_full ? 8 : 0));
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const int x = trace.x(), y = trace.y();
        const glm::vec4 sums = read_texel(m_gl, m_sums, x, y);
        std::vector<PixelFact> facts = {
            color_fact("color_sum", glm::vec3(sums), "S, the sum of alpha times colour over all fragments."),
            number_fact("alpha_sum", sums.a, "A, the sum of the alphas.")};
        if (m_full) {
            facts.push_back(number_fact("alpha_product", read_texel(m_gl, m_products, x, y).r,
                                        "P, the product of the alphas that are not 0."));
            facts.push_back(number_fact("reciprocal_sum", read_texel(m_gl, m_reciprocals, x, y).r,
                                        "R, the sum of one over each alpha that is not 0."));
        }
        bind_sums();
        const bool is_empty = m_full ? read_texel(m_gl, m_reciprocals, x, y).r == 0 : sums.a == 0;
        const double weight = is_empty ? 1 : shade_texel(m_gl, m_composite, m_target, x, y, 1).r;
        facts.push_back(number_fact("opaque_weight", weight,
                                    m_full ? "What the opaque colour is weighed by beside S: 1 - A + P - R P."
                                           : "What the opaque colour is weighed by beside S: 1 - A."));
        return facts;
    }

  private:
    std::string prolog() const { return std::string("#define FULL ") + (m_full ? "1" : "0") + "\n"; }

    gl::Texture texture(const std::string& what, GLenum format) const {
        return gl::make_texture_2d(m_gl, "meshkin: " + what, format, m_target.width_px(), m_target.height_px());
    }

    void clear() const {
        const glm::vec4 zero(0), one(1);
        begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
        m_gl.ClearBufferfv(GL_COLOR, 0, &zero[0]);
        if (!m_full) return;
        m_gl.ClearBufferfv(GL_COLOR, 1, &zero[0]);
        begin_pass(m_gl, m_product_framebuffer, m_target.width_px(), m_target.height_px());
        m_gl.ClearBufferfv(GL_COLOR, 0, &one[0]);
    }

    void begin_blending(const gl::Framebuffer& framebuffer, GLenum source_factor, GLenum target_factor) const {
        begin_pass(m_gl, framebuffer, m_target.width_px(), m_target.height_px());
        set_transparent_depth_state(m_gl);
        m_gl.Enable(GL_BLEND);
        m_gl.BlendFunc(source_factor, target_factor);
    }

    /// Reads D from the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, 9.3.1).
    void composite() const {
        begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
        m_gl.TextureBarrier();
        bind_sums();
        m_composite.draw();
    }

    void bind_sums() const {
        m_gl.BindTextureUnit(unit_opaque, m_target.color().id());
        m_gl.BindTextureUnit(unit_sums, m_sums.id());
        if (m_full) {
            m_gl.BindTextureUnit(unit_reciprocals, m_reciprocals.id());
            m_gl.BindTextureUnit(unit_products, m_products.id());
        }
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    bool m_full, m_in_32_bits;
    OpaquePass m_opaque;
    gl::Program m_accumulate, m_multiply;
    FullscreenPass m_composite;
    gl::Texture m_sums, m_reciprocals, m_products;
    gl::Framebuffer m_framebuffer, m_product_framebuffer;
};

}  // namespace

MethodInfo method_meshkin() {
    return {
        .id = "meshkin",
        .name = "Meshkin",
        .kind = "order-independent, approximate",
        .summary = "Additive sums in any order; what of the blended colour depends on the order is left out.",
        .paper = "Meshkin, Sort-Independent Alpha Blending, GDC 2007",
        .good_at = "Many faint layers without sorting; the simple variant is exact for one layer.",
        .bad_at =
            "Alphas over about 0.3: four layers of alpha 1 are off by up to three times the background. The full "
            "variant is derived for four layers and wrong for one or two: one layer loses the background.",
        .memory = "8 bytes per pixel, 16 with rgba32f; 8 more in the full variant",
        .needs_sorting = false,
        .parameters = {Param::choice("variant",
                                     "simple: D + S - D A; full: also the terms of the reciprocals and of the "
                                     "product of the alphas, in one more target and one more pass",
                                     "simple", {"simple", "full"})},
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> { return std::make_unique<Meshkin>(setup); },
    };
}

}  // namespace sheer
