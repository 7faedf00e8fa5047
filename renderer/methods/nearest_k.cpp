// The k nearest fragments of each pixel: a k-buffer (Bavoil et al., Multi-Fragment Effects on the GPU using the
// k-Buffer, I3D 2007) that is filled by a chain of atomic minima of 32-bit keys, 24 bits of depth above 8 of
// transmittance, in any order. A second pass over the scene blends a fragment by what the keys in front of it let
// through. What happens to the other fragments is a parameter; if their weighted average is laid behind the nearest, it
// is hybrid transparency (Maule, Comba, Torchelsen, Bastos, Hybrid Transparency, I3D 2013). What is behind sees
// transmittances in steps of 1/255. Fragments of equal depth share what reaches them.
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

struct NearestKParameters {
    enum class Rest { dropped, transmittance, weighted_average };

    int k = 8;
    Rest rest = Rest::weighted_average;

    static ParamTable<NearestKParameters> table() {
        return ParamTable<NearestKParameters>()
            .integer(&NearestKParameters::k, "k", "fragments that are kept in each pixel", "", 1, 32)
            .choice(
                &NearestKParameters::rest, "rest",
                "what happens to the fragments behind them: dropped; transmittance: they darken what is behind them, "
                "but have no color; weighted_average: they are one layer of their average color (hybrid transparency)",
                {{"dropped", Rest::dropped},
                 {"transmittance", Rest::transmittance},
                 {"weighted_average", Rest::weighted_average}});
    }
};

class NearestK : public OpaqueFirst {
  public:
    NearestK(const MethodSetup& setup, const NearestKParameters& parameters)
        : OpaqueFirst(setup),
          m_keeps_rest(parameters.rest != NearestKParameters::Rest::dropped),
          m_collect(setup.scene.make_program("nearest k: collect", source("collect"), prolog(parameters))),
          m_blend(setup.scene.make_program("nearest k: blend", source("blend"), prolog(parameters))),
          m_composite(setup.gl, "nearest k: composite", source("composite"), prolog(parameters)),
          m_keys(gl::make_buffer(setup.gl, "nearest k: keys", keys_bytes(setup, parameters.k), nullptr)),
          m_near(setup.target.make_texture("nearest k: near", GL_RGBA32F)) {
        for (const gl::Program* program :
             std::initializer_list<const gl::Program*>{&m_collect, &m_blend, &m_composite.program()})
            program->set("u_width", m_target.width_px());
        const GLuint depth = m_target.depth().id();
        if (!m_keeps_rest) {
            m_framebuffer = gl::make_framebuffer(m_gl, "nearest k: blend", std::array{m_near.id()}, depth);
            return;
        }
        m_rest = m_target.make_texture("nearest k: rest", GL_RGBA32F);
        m_rest_transmittance = m_target.make_texture("nearest k: transmittance of the rest", GL_R32F);
        m_framebuffer = gl::make_framebuffer(m_gl, "nearest k: blend",
                                             std::array{m_near.id(), m_rest.id(), m_rest_transmittance.id()}, depth);
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("collect", gl::Phase::transparent);
            collect();
        }
        {
            const auto pass = timer.pass("blend", gl::Phase::transparent);
            blend();
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        const Pass drawing = begin();
        m_gl.TextureBarrier();
        set_textures();
        m_composite.draw();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        set_textures();
        std::vector<PixelFact> facts = {
            color_fact(
                "near_color", glm::vec3(read_texel(m_gl, m_near, trace.x(), trace.y())),
                "The sum over the nearest fragments of alpha times color times what those in front let through."),
            number_fact("near_transmittance", transmittance_at(trace), "What all of the nearest let through.")};
        if (!m_keeps_rest) return facts;
        facts.push_back(number_fact("rest_transmittance",
                                    read_texel(m_gl, m_rest_transmittance, trace.x(), trace.y()).r,
                                    "What the other fragments let through."));
        return facts;
    }

    std::int64_t memory_bytes() const override {
        return gl::memory_bytes_of(m_keys, m_near, m_rest, m_rest_transmittance);
    }

  private:
    static std::string source(const std::string& pass) {
        return gl::shader_file("methods/nearest_k_keys.glsl") + gl::shader_file("methods/nearest_k_" + pass + ".glsl");
    }

    static std::string prolog(const NearestKParameters& parameters) {
        using Rest = NearestKParameters::Rest;
        return "#define SHEER_K " + std::to_string(parameters.k) + "\n#define SHEER_KEEPS_REST " +
               (parameters.rest == Rest::dropped ? "0" : "1") + "\n#define SHEER_AVERAGES_REST " +
               (parameters.rest == Rest::weighted_average ? "1" : "0") + "\n";
    }

    static GLsizeiptr keys_bytes(const MethodSetup& setup, int k) {
        const auto bytes = GLsizeiptr{4} * k * setup.target.width_px() * setup.target.height_px();
        std::int64_t largest_block = 0;
        setup.gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest_block);
        if (bytes > largest_block)
            throw Unsupported("k " + std::to_string(k) + " needs a buffer of " + std::to_string(bytes) +
                              " bytes; this device allows " + std::to_string(largest_block));
        return bytes;
    }

    void bind_keys() const {
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, m_keys.id());
        m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    void collect() const {
        const std::uint32_t no_key = ~0u;
        m_gl.ClearNamedBufferData(m_keys.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &no_key);
        Pass drawing = begin();
        bind_keys();
        drawing.transparent_depth();
        drawing.no_color();
        m_scene.draw_transparent(m_collect, Order::submission);
    }

    void blend() const {
        Pass drawing = begin(m_framebuffer);
        bind_keys();
        drawing.clear_color(glm::vec4(0));
        drawing.transparent_depth();
        drawing.blend(GL_ONE, GL_ONE);
        if (m_keeps_rest) {
            drawing.clear_color(glm::vec4(0), 1);
            drawing.clear_color(glm::vec4(1), 2);
            drawing.blend_output(2, GL_ZERO, GL_ONE_MINUS_SRC_COLOR, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
        }
        m_scene.draw_transparent(m_blend, Order::submission);
    }

    void set_textures() const {
        bind_keys();
        const gl::Program& program = m_composite.program();
        program.set_texture("u_opaque", m_target.color());
        program.set_texture("u_near", m_near);
        if (!m_keeps_rest) return;
        program.set_texture("u_rest", m_rest);
        program.set_texture("u_rest_transmittance", m_rest_transmittance);
    }

    /// 1 where the composite discards.
    double transmittance_at(const PixelTrace& trace) const {
        return trace.of(m_blend).passed().empty() ? 1
                                                  : shade_texel(m_gl, m_composite, m_target, trace.x(), trace.y(), 1).r;
    }

    bool m_keeps_rest;
    gl::Program m_collect, m_blend;
    FullscreenPass m_composite;
    gl::Buffer m_keys;
    gl::Texture m_near, m_rest, m_rest_transmittance;
    gl::Framebuffer m_framebuffer;
};

}  // namespace

MethodInfo method_nearest_k() {
    return describe_method(
        {
            .id = "nearest_k",
            .name = "Nearest k",
            .kind = "order-independent, exact for few layers",
            .summary =
                "The k nearest fragments of each pixel are blended exactly; the others are dropped or approximated.",
            .paper = "Bavoil et al., Multi-Fragment Effects on the GPU using the k-Buffer, I3D 2007; with the weighted "
                     "average: Maule, Comba, Torchelsen, Bastos, Hybrid Transparency, I3D 2013",
            .good_at =
                "Exact for up to k layers, in any order of submission and for intersecting primitives, in bounded "
                "memory.",
            .bad_at =
                "What is behind the k nearest is lost or blurred; transmittances have 8 bits; two passes over the "
                "scene.",
            .memory = "4 k + 16 bytes per pixel, 20 more if the rest is not dropped",
            .passes = "2, and a full-screen one",
            .needs = "storage buffers and atomics in fragment shaders",
            .needs_sorting = false,
        },
        NearestKParameters::table(), make_new<NearestK>,
        [](const NearestKParameters& parameters, int) -> std::optional<double> {
            return 4 * parameters.k + (parameters.rest == NearestKParameters::Rest::dropped ? 16 : 36);
        });
}

}  // namespace sheer
