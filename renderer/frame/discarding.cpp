#include "renderer/frame/discarding.h"

#include <algorithm>
#include <map>

namespace sheer {

namespace {

constexpr const char* fetch_extension = "GL_EXT_shader_framebuffer_fetch";

gl::Program make_program(const MethodSetup& setup, bool framebuffer_fetch, bool separate_alpha) {
    const bool if_else = setup.parameters.at("form") == "if_else";
    if (framebuffer_fetch && !setup.context.has_extension(fetch_extension))
        throw Unsupported(std::string("feedback framebuffer_fetch needs ") + fetch_extension);
    std::string prolog;
    if (framebuffer_fetch) prolog += std::string("#extension ") + fetch_extension + " : require\n";
    prolog += framebuffer_fetch ? "#define FRAMEBUFFER_FETCH 1\n" : "#define FRAMEBUFFER_FETCH 0\n";
    prolog += separate_alpha ? "#define SEPARATE_ALPHA 1\n" : "#define SEPARATE_ALPHA 0\n";
    prolog += if_else ? "#define IF_ELSE 1\n" : "#define IF_ELSE 0\n";
    prolog += alpha_form_prolog(alpha_form(setup.parameters));
    return setup.scene.make_program("f2bd", gl::shader_file("methods/f2bd.glsl"), prolog);
}

bool separate(const MethodSetup& setup) {
    return setup.parameters.at("alpha_target") == "separate";
}

}  // namespace

std::vector<Param> discarding_parameters() {
    std::vector<Param> parameters = {
        Param::number("threshold", "a fragment is discarded where less than this transmittance is left", "", 0.01, 0,
                      1),
        Param::choice(
            "sync",
            "how the caches are made to see the clear and each batch: a texture barrier, binding framebuffer 0 "
            "and back, glFlush or glFinish (which do not help, says the paper), or not at all (shows the artefacts of "
            "its Figure 3 on hardware)",
            "barrier", {"barrier", "rebind", "flush", "finish", "none"}),
        Param::choice("alpha_target", "read the transmittance from the colour target or from one of a single channel",
                      "shared", {"shared", "separate"}),
        Param::choice("feedback", "how the fragment reads it", "texture", {"texture", "framebuffer_fetch"}),
        Param::integer("batch", "primitives between synchronisations; 0 synchronises after the clear only", "", 0, 0,
                       1000000),
        Param::choice(
            "form",
            "the shader's: discard or else shade, as the paper prints it, or discard and go on, which it found "
            "slower on some hardware",
            "if_else", {"if_else", "if_discard"}),
    };
    for (Param& param : alpha_form_parameters()) parameters.push_back(std::move(param));
    return parameters;
}

DiscardingBlending::DiscardingBlending(const MethodSetup& setup, float initial_transmittance)
    : m_gl(setup.gl),
      m_scene(setup.scene),
      m_initial_transmittance(initial_transmittance),
      m_threshold(setup.parameters.at("threshold").get<float>()),
      m_sync(sync_named(setup.parameters.at("sync"))),
      m_framebuffer_fetch(setup.parameters.at("feedback") == "framebuffer_fetch"),
      m_batch(setup.parameters.at("batch").get<std::size_t>()),
      m_opaque(setup.gl, setup.scene, setup.target),
      m_accumulation(setup.gl, setup.target, setup.target.format(), separate(setup), alpha_form(setup.parameters)),
      m_program(make_program(setup, m_framebuffer_fetch, separate(setup))) {
    m_program.set("u_threshold", m_threshold);
}

DiscardingBlending::Sync DiscardingBlending::sync_named(const std::string& name) {
    static const std::map<std::string, Sync> all = {{"barrier", Sync::barrier},
                                                    {"rebind", Sync::rebind},
                                                    {"flush", Sync::flush},
                                                    {"finish", Sync::finish},
                                                    {"none", Sync::none}};
    return all.at(name);
}

void DiscardingBlending::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("clear", gl::Phase::initialization);
        m_accumulation.clear(m_initial_transmittance);
        synchronise();
    }
    {
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        m_accumulation.begin_blending();
        if (!m_framebuffer_fetch) m_gl.BindTextureUnit(first_method_texture_unit, m_accumulation.readable_alpha().id());
        draw_batches();
    }
    const auto pass = timer.pass("composite", gl::Phase::finalization);
    m_accumulation.composite();
}

void DiscardingBlending::draw_batches() const {
    const std::size_t count = m_scene.transparent_count();
    const std::size_t step = m_batch == 0 ? std::max<std::size_t>(count, 1) : m_batch;
    for (std::size_t first = 0; first < count; first += step) {
        if (first > 0) synchronise();
        m_scene.draw_transparent(m_program, Order::near_to_far, first, std::min(step, count - first));
    }
}

std::vector<PixelFact> DiscardingBlending::explain(const PixelTrace& trace) const {
    const PixelTrace::Draws draws = trace.of(m_program);
    const std::vector<std::size_t> discarded = draws.failed();
    std::vector<PixelFact> facts = {
        fragments_fact("blended", draws.passed(), "The fragments that found enough of the transmittance left."),
        fragments_fact("discarded", discarded, "The fragments that gave up before they were shaded."),
        fragment_fact("saturated_at", discarded.empty() ? std::nullopt : draws.last_passed(),
                      "The fragment after which less than the threshold was left; none if nothing was discarded, or "
                      "if all was.")};
    add_accumulated(facts, draws.color, m_accumulation.form());
    return facts;
}

void DiscardingBlending::synchronise() const {
    switch (m_sync) {
        case Sync::barrier:
            m_gl.TextureBarrier();
            break;
        case Sync::rebind:
            m_gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
            m_gl.BindFramebuffer(GL_FRAMEBUFFER, m_accumulation.framebuffer().id());
            break;
        case Sync::flush:
            m_gl.Flush();
            break;
        case Sync::finish:
            m_gl.Finish();
            break;
        case Sync::none:
            break;
    }
}

}  // namespace sheer
