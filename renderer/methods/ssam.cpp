// Screen-space alpha masking: Hathaway, "Alpha Blending as a Post-Process", GPU Pro (2010). Four passes, and a fifth
// for what is not foliage:
//   1. the opaque picture and its depth, at `opaque_msaa` samples; of the depths the nearest is kept, never a mean;
//   2. a mask: the alpha of every fragment, its maximum in the color channels and its sum in alpha (Table 3.1);
//   3. the nearest color, by alpha test at `alpha_reference`, without blending, with depth writes;
//   4. lerp(opaque, color, mask^2), with mask = lerp(maximum, sum, `mask_lerp`) (Listing 3.2);
//   5. the last `drawn_after` objects as submitted, blended from far to near, tested against the depth that the color
//      pass wrote (section 3.7: grass, light shafts, particles).
// Section 3.5.4 prints the two masks the other way round; the listing and the prose (85 % additive) agree, so these are
// followed. Where the mask is above 0 but no fragment passes the test, the clear color is visible.
#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/multisample.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

struct SsamParameters {
    enum class Mask { combined, max, additive };

    double mask_lerp = 0.85;
    double alpha_reference = 64.0 / 255;
    bool squared = true;
    Mask mask = Mask::combined;
    int opaque_msaa = 1;
    std::array<double, 3> clear_color = {0, 0, 0};
    std::size_t drawn_after = 0;

    static ParamTable<SsamParameters> table() {
        return ParamTable<SsamParameters>()
            .number(&SsamParameters::mask_lerp, "mask_lerp", "share of the additive mask; the rest is the maximum", "",
                    0, 1)
            .number(&SsamParameters::alpha_reference, "alpha_reference",
                    "the least alpha that gives color; the article's range is 64/255 to 128/255", "", 0, 1)
            .boolean(&SsamParameters::squared, "squared", "blend by the square of the mask, which hides the halos")
            .choice(&SsamParameters::mask, "mask",
                    "both masks by mask_lerp, or one alone as in the article's first attempts",
                    {{"combined", Mask::combined}, {"max", Mask::max}, {"additive", Mask::additive}})
            .integer(&SsamParameters::opaque_msaa, "opaque_msaa",
                     "samples per pixel of the opaque pass; 2 uses the lowest number from 2 up that the device has",
                     "samples", 1, 2)
            .color(&SsamParameters::clear_color, "clear_color", "what lies behind the nearest color")
            .integer(&SsamParameters::drawn_after, "drawn_after",
                     "so many of the last submitted transparent objects are not foliage: they are blended afterwards, "
                     "tested against the foliage's depth",
                     "", 0, 1000000);
    }

    /// The share of the additive mask.
    double additive_part() const {
        switch (mask) {
            case Mask::combined:
                return mask_lerp;
            case Mask::max:
                return 0;
            case Mask::additive:
                return 1;
        }
        throw std::logic_error("unknown mask");
    }
};

class ScreenSpaceAlphaMask : public OpaqueFirst {
  public:
    ScreenSpaceAlphaMask(const MethodSetup& setup, const SsamParameters& parameters)
        : OpaqueFirst(setup),
          m_clear_color(parameters.clear_color[0], parameters.clear_color[1], parameters.clear_color[2], 1),
          m_foliage_count(m_scene.transparent_count() - std::min(parameters.drawn_after, m_scene.transparent_count())),
          m_draw_mask(setup.scene.make_program("ssam: mask", gl::shader_file("methods/ssam_mask.glsl"))),
          m_draw_color(setup.scene.make_program("ssam: color", gl::shader_file("methods/alpha_test.glsl"))),
          m_nearest_depth(setup.gl, "ssam: nearest depth", gl::shader_file("methods/ssam_nearest_depth.glsl")),
          m_composite(setup.gl, "ssam: composite", gl::shader_file("methods/ssam_composite.glsl")),
          m_mask(texture("mask")),
          m_foliage(texture("foliage")),
          m_mask_framebuffer(framebuffer("mask", m_mask)),
          m_foliage_framebuffer(framebuffer("foliage", m_foliage)) {
        if (m_foliage_count < setup.scene.transparent_count())
            m_draw_after = setup.scene.make_program("ssam: after", gl::shader_file("methods/b2f.glsl"));
        if (parameters.opaque_msaa == 2) m_multisample.emplace(setup.gl, setup.target, 2);
        m_draw_color.set("u_least_alpha", setup.scene.least_alpha(parameters.alpha_reference));
        m_composite.program().set("u_additive_part", static_cast<float>(parameters.additive_part()));
        m_composite.program().set("u_squared", parameters.squared ? 1 : 0);
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
        set_textures();
        std::vector<PixelFact> facts = {
            fragment_fact("chosen", trace.of(m_draw_color).last_passed(),
                          "The nearest fragment that passed the alpha test; its color is laid over the opaque picture. "
                          "None if the clear color is used."),
            color_fact("color", glm::vec3(read_texel(m_gl, m_foliage, x, y)), "That color."),
            number_fact("mask_maximum", masks.r, "The greatest alpha of the pixel's fragments."),
            number_fact("mask_sum", masks.a, "The sum of their alphas; over 1 it counts as 1."),
            number_fact(
                "blend", shade_texel(m_gl, m_composite, m_target, x, y, 1).r,
                "How much of that color is seen, computed from the two masks; the rest is the opaque picture.")};
        if (m_foliage_count < m_scene.transparent_count())
            facts.push_back(
                fragments_fact("after", trace.of(m_draw_after).passed(),
                               "The fragments that are not foliage and were blended afterwards, far to near."));
        return facts;
    }

    std::int64_t memory_bytes() const override {
        return gl::memory_bytes_of(m_mask, m_foliage) + (m_multisample ? m_multisample->memory_bytes() : 0);
    }

  private:
    gl::Texture texture(const std::string& what) const {
        return m_target.make_texture("ssam: " + what, gl_format(m_target.format()));
    }

    gl::Framebuffer framebuffer(const std::string& what, const gl::Texture& texture) const {
        return gl::make_framebuffer(m_gl, "ssam: " + what, std::array{texture.id()}, m_target.depth().id());
    }

    void resolve() const {
        m_multisample->resolve_color();
        Pass drawing = begin();
        drawing.no_color();
        drawing.depth_test(GL_ALWAYS);  // without a test no depth is written
        m_nearest_depth.program().set_texture("u_depth", m_multisample->depth());
        m_nearest_depth.program().set("u_samples", m_multisample->samples());
        m_nearest_depth.draw();
    }

    void draw_mask() const {
        Pass drawing = begin(m_mask_framebuffer);
        drawing.clear_color(glm::vec4(0));
        drawing.transparent_depth();
        drawing.blend_equation(GL_MAX, GL_FUNC_ADD);
        drawing.blend(GL_ONE, GL_ONE);
        m_scene.draw_transparent(m_draw_mask, Order::submission, 0, m_foliage_count);
    }

    void draw_color() const {
        Pass drawing = begin(m_foliage_framebuffer);
        drawing.clear_color(m_clear_color);
        drawing.depth_test(GL_LEQUAL);
        m_scene.draw_transparent(m_draw_color, Order::submission, 0, m_foliage_count);
    }

    /// Reads the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, section 9.3.1).
    void composite() const {
        const Pass drawing = begin();
        m_gl.TextureBarrier();
        set_textures();
        m_composite.draw();
    }

    void set_textures() const {
        m_composite.program().set_texture("u_opaque", m_target.color());
        m_composite.program().set_texture("u_mask", m_mask);
        m_composite.program().set_texture("u_foliage", m_foliage);
    }

    /// Primitives that are adjacent in the order are drawn together.
    void draw_after() const {
        Pass drawing = begin();
        drawing.transparent_depth();
        drawing.blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
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

    glm::vec4 m_clear_color;
    std::size_t m_foliage_count;  ///< the first transparent primitives in the order of submission
    gl::Program m_draw_mask, m_draw_color, m_draw_after;
    FullscreenPass m_nearest_depth, m_composite;
    gl::Texture m_mask, m_foliage;
    gl::Framebuffer m_mask_framebuffer, m_foliage_framebuffer;
    std::optional<Multisample> m_multisample;  ///< if the opaque pass is not drawn directly into the target
};

}  // namespace

MethodInfo method_ssam() {
    return describe_method(
        {
            .id = "ssam",
            .name = "SSAM",
            .kind = "order-independent, approximate",
            .summary = "Screen-space alpha masking: the nearest color by alpha test, laid over the opaque picture by a "
                       "mask of the alphas' maximum and sum.",
            .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010",
            .good_at =
                "Foliage: soft edges and intersections without sorting; one blend per pixel, whatever the overdraw.",
            .bad_at = "Glass and smoke: only the nearest color shows, however faint; halos of the clear color.",
            .memory = "two pixels of the image format; with opaque_msaa 2 also the samples, color and depth",
            .passes = "2, and 2 full-screen ones; 1 more if something is drawn after the foliage",
            .needs = "the blend equation MAX",
            .needs_sorting = false,
        },
        SsamParameters::table(), make_new<ScreenSpaceAlphaMask>,
        [](const SsamParameters& parameters, int pixel_bytes) -> std::optional<double> {
            // How many samples 2 stands for is the device's choice.
            return parameters.opaque_msaa > 1 ? std::nullopt : std::optional(2.0 * pixel_bytes);
        },
        [](const Scene&, const SsamParameters& parameters) { return parameters.drawn_after > 0; });
}

}  // namespace sheer
