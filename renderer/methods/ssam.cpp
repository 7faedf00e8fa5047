// Screen-space alpha masking: Hathaway, "Alpha Blending as a Post-Process", GPU Pro (2010). Four passes, and a fifth
// for what is not foliage:
//   1. the opaque picture and its depth, at `opaque_msaa` samples; of the depths the nearest is kept, never a mean;
//   2. a mask: the alpha of every fragment, its maximum in the colour channels and its sum in alpha (Table 3.1);
//   3. the nearest colour, by alpha test at `alpha_reference`, without blending, with depth writes;
//   4. lerp(opaque, colour, mask^2), with mask = lerp(maximum, sum, `mask_lerp`) (Listing 3.2);
//   5. the last `drawn_after` objects as submitted, blended from far to near, tested against the depth that the colour
//      pass wrote (section 3.7: grass, light shafts, particles).
// Section 3.5.4 prints the two masks the other way round; the listing and the prose (85 % additive) agree, so they
// hold. Good at: foliage: soft edges, intersections right per pixel, no sorting. Bad at: glass and smoke: only the
// nearest colour is seen, however faint; where the mask is above 0 but no fragment passes the test, the clear colour
// is. Parameters: `mask_lerp` 0..1, 0.85; `alpha_reference` 0..1, 64/255 (the article's range is 64/255 to 128/255);
// `squared` true; `mask` combined, max or additive, combined; `opaque_msaa` 1 or 2 samples, 1; `clear_color` black;
// `drawn_after` 0.
#include <algorithm>
#include <array>
#include <optional>

#include "renderer/frame/multisample.h"
#include "renderer/frame/texel.h"
#include "renderer/methods/method.h"

namespace sheer {

namespace {

constexpr GLuint opaque_unit = first_method_texture_unit, mask_unit = opaque_unit + 1, foliage_unit = opaque_unit + 2;

class ScreenSpaceAlphaMask : public Method {
  public:
    explicit ScreenSpaceAlphaMask(const MethodSetup& setup)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_clear_color(color(setup.parameters.at("clear_color"))),
          m_foliage_count(foliage_count(setup)),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_draw_mask(setup.scene.make_program("ssam: mask", gl::shader_file("methods/ssam_mask.glsl"))),
          m_draw_color(setup.scene.make_program("ssam: color", gl::shader_file("methods/alpha_test.glsl"))),
          m_nearest_depth(setup.gl, "ssam: nearest depth", gl::shader_file("methods/ssam_nearest_depth.glsl")),
          m_composite(setup.gl, "ssam: composite", gl::shader_file("methods/ssam_composite.glsl")),
          m_mask(texture("mask")),
          m_foliage(texture("foliage")),
          m_mask_framebuffer(framebuffer("mask", m_mask)),
          m_foliage_framebuffer(framebuffer("foliage", m_foliage)) {
        const auto& parameters = setup.parameters;
        if (m_foliage_count < setup.scene.transparent_count())
            m_draw_after = setup.scene.make_program("ssam: after", gl::shader_file("methods/b2f.glsl"));
        if (parameters.at("opaque_msaa") == 2) m_multisample.emplace(setup.gl, setup.target, 2);
        m_draw_color.set("u_least_alpha", setup.scene.least_alpha(parameters.at("alpha_reference")));
        const auto mask = parameters.at("mask").get<std::string>();
        const float additive_part = mask == "combined" ? parameters.at("mask_lerp").get<float>()
                                    : mask == "max"    ? 0.0f
                                                       : 1.0f;
        m_composite.program().set("u_additive_part", additive_part);
        m_composite.program().set("u_squared", parameters.at("squared").get<bool>() ? 1 : 0);
    }

    void render(gl::FrameTimer& timer) override {
        if (m_multisample) {
            m_opaque.draw_into(m_multisample->framebuffer(), timer);
            const auto pass = timer.pass("resolve", gl::Phase::opaque);
            resolve();
        } else {
            m_opaque.draw(timer);
        }
        {
            const auto pass = timer.pass("mask", gl::Phase::transparent);
            draw_mask();
        }
        {
            const auto pass = timer.pass("color", gl::Phase::transparent);
            draw_color();
        }
        {
            const auto pass = timer.pass("composite", gl::Phase::finalization);
            composite();
        }
        if (m_foliage_count == m_scene.transparent_count()) return;
        const auto pass = timer.pass("after", gl::Phase::transparent);
        draw_after();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const int x = trace.x(), y = trace.y();
        const glm::vec4 masks = read_texel(m_gl, m_mask, x, y);
        bind_parts();
        std::vector<PixelFact> facts = {
            fragment_fact("chosen", trace.of(m_draw_color).last_passed(),
                          "The nearest fragment that passed the alpha test, whose colour is laid over the opaque "
                          "picture; none if it is the clear colour."),
            color_fact("color", glm::vec3(read_texel(m_gl, m_foliage, x, y)), "That colour."),
            number_fact("mask_maximum", masks.r, "The greatest alpha of the pixel's fragments."),
            number_fact("mask_sum", masks.a, "The sum of their alphas; over 1 it counts as 1."),
            number_fact("blend", shade_texel(m_gl, m_composite, m_target, x, y, 1).r,
                        "How much of that colour is seen, made of the two masks; the rest is the opaque picture.")};
        if (m_foliage_count < m_scene.transparent_count())
            facts.push_back(
                fragments_fact("after", trace.of(m_draw_after).passed(),
                               "The fragments that are no foliage and were blended afterwards, far to near."));
        return facts;
    }

    std::int64_t memory_bytes() const override {
        const std::int64_t pixels = std::int64_t{m_target.width_px()} * m_target.height_px();
        return 2 * pixels * bytes_per_pixel(m_target.format()) + (m_multisample ? m_multisample->memory_bytes() : 0);
    }

  private:
    static glm::vec4 color(const nlohmann::json& rgb) {
        return {rgb.at(0).get<float>(), rgb.at(1).get<float>(), rgb.at(2).get<float>(), 1.0f};
    }

    static std::size_t foliage_count(const MethodSetup& setup) {
        const auto after = setup.parameters.at("drawn_after").get<std::size_t>();
        return setup.scene.transparent_count() - std::min(after, setup.scene.transparent_count());
    }

    gl::Texture texture(const std::string& what) const {
        return gl::make_texture_2d(m_gl, "ssam: " + what, gl_format(m_target.format()), m_target.width_px(),
                                   m_target.height_px());
    }

    gl::Framebuffer framebuffer(const std::string& what, const gl::Texture& texture) const {
        return gl::make_framebuffer(m_gl, "ssam: " + what, std::array{texture.id()}, m_target.depth().id());
    }

    void begin(const gl::Framebuffer& framebuffer) const {
        begin_pass(m_gl, framebuffer, m_target.width_px(), m_target.height_px());
    }

    void resolve() const {
        m_multisample->resolve_color();
        begin(m_target.framebuffer());
        m_gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        m_gl.Enable(GL_DEPTH_TEST);  // without it no depth is written
        m_gl.DepthFunc(GL_ALWAYS);
        m_gl.BindTextureUnit(first_method_texture_unit, m_multisample->depth().id());
        m_nearest_depth.program().set("u_samples", m_multisample->samples());
        m_nearest_depth.draw();
    }

    void draw_mask() const {
        const glm::vec4 zero(0);
        begin(m_mask_framebuffer);
        m_gl.ClearBufferfv(GL_COLOR, 0, &zero[0]);
        set_transparent_depth_state(m_gl);
        m_gl.Enable(GL_BLEND);
        m_gl.BlendEquationSeparate(GL_MAX, GL_FUNC_ADD);
        m_gl.BlendFunc(GL_ONE, GL_ONE);
        m_scene.draw_transparent(m_draw_mask, Order::submission, 0, m_foliage_count);
    }

    void draw_color() const {
        begin(m_foliage_framebuffer);
        m_gl.ClearBufferfv(GL_COLOR, 0, &m_clear_color[0]);
        m_gl.Enable(GL_DEPTH_TEST);
        m_gl.DepthFunc(GL_LEQUAL);
        m_scene.draw_transparent(m_draw_color, Order::submission, 0, m_foliage_count);
    }

    /// Reads the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, section 9.3.1).
    void composite() const {
        begin(m_target.framebuffer());
        m_gl.TextureBarrier();
        bind_parts();
        m_composite.draw();
    }

    void bind_parts() const {
        m_gl.BindTextureUnit(opaque_unit, m_target.color().id());
        m_gl.BindTextureUnit(mask_unit, m_mask.id());
        m_gl.BindTextureUnit(foliage_unit, m_foliage.id());
    }

    /// Those of a stretch that lie side by side in the order are drawn together.
    void draw_after() const {
        begin(m_target.framebuffer());
        set_transparent_depth_state(m_gl);
        m_gl.Enable(GL_BLEND);
        m_gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        const std::size_t count = m_scene.transparent_count();
        const std::uint32_t first_after = m_scene.primitive_at(Order::submission, m_foliage_count);
        const auto is_foliage = [&](std::size_t i) {
            return m_scene.primitive_at(Order::far_to_near, i) < first_after;
        };
        for (std::size_t i = 0; i < count;) {
            const std::size_t first = i;
            while (i < count && !is_foliage(i)) ++i;
            if (i > first) m_scene.draw_transparent(m_draw_after, Order::far_to_near, first, i - first);
            while (i < count && is_foliage(i)) ++i;
        }
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    glm::vec4 m_clear_color;
    std::size_t m_foliage_count;  ///< the first of the transparent primitives as submitted
    OpaquePass m_opaque;
    gl::Program m_draw_mask, m_draw_color, m_draw_after;
    FullscreenPass m_nearest_depth, m_composite;
    gl::Texture m_mask, m_foliage;
    gl::Framebuffer m_mask_framebuffer, m_foliage_framebuffer;
    std::optional<Multisample> m_multisample;  ///< where the opaque pass is not drawn straight into the target
};

}  // namespace

MethodInfo method_ssam() {
    return {
        .id = "ssam",
        .name = "SSAM",
        .kind = "order-independent, approximate",
        .summary =
            "Screen-space alpha masking: the nearest colour by alpha test, laid over the opaque picture by a "
            "mask of the alphas' maximum and sum.",
        .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010",
        .good_at = "Foliage: soft edges and intersections without sorting; one blend per pixel, whatever the overdraw.",
        .bad_at = "Glass and smoke: only the nearest colour shows, however faint; halos of the clear colour.",
        .memory = "two pixels of the image format; with opaque_msaa 2 also the samples, colour and depth",
        .needs_sorting = false,
        .sorts_here = [](const Scene&, const nlohmann::json& parameters) { return parameters.at("drawn_after") > 0; },
        .parameters = {Param::number("mask_lerp", "part of the additive mask; the rest is the maximum", "", 0.85, 0, 1),
                       Param::number("alpha_reference",
                                     "the least alpha that gives colour; the article's range is 64/255 to 128/255", "",
                                     64.0 / 255, 0, 1),
                       Param::boolean("squared", "blend by the square of the mask, which hides the halos", true),
                       Param::choice("mask", "both masks by mask_lerp, or one alone as in the article's first attempts",
                                     "combined", {"combined", "max", "additive"}),
                       Param::integer("opaque_msaa",
                                      "samples per pixel of the opaque pass; for 2, the fewest from 2 up that the "
                                      "device has",
                                      "samples", 1, 1, 2),
                       Param::numbers("clear_color", "what lies behind the nearest colour: red, green, blue", "",
                                      {0, 0, 0}, 0, 1),
                       Param::integer("drawn_after",
                                      "the last so many transparent objects, as submitted, are no foliage: they are "
                                      "blended afterwards, tested against the foliage's depth",
                                      "", 0, 0, 1000000)},
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<ScreenSpaceAlphaMask>(setup);
        },
    };
}

}  // namespace sheer
