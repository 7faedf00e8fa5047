#include "renderer/methods/shared/discarding.h"

#include <algorithm>

namespace sheer {

namespace {

constexpr const char* fetch_extension = "GL_EXT_shader_framebuffer_fetch";

bool fetches(const DiscardingParameters& parameters) {
    return parameters.feedback == DiscardingParameters::Feedback::framebuffer_fetch;
}

bool is_separate(const DiscardingParameters& parameters) {
    return parameters.alpha_target == DiscardingParameters::AlphaTarget::separate;
}

gl::Program make_program(const MethodSetup& setup, const DiscardingParameters& parameters) {
    if (fetches(parameters) && !setup.context.has_extension(fetch_extension))
        throw Unsupported(std::string("feedback framebuffer_fetch needs ") + fetch_extension);
    std::string prolog;
    if (fetches(parameters)) prolog += std::string("#extension ") + fetch_extension + " : require\n";
    prolog += fetches(parameters) ? "#define SHEER_FRAMEBUFFER_FETCH 1\n" : "#define SHEER_FRAMEBUFFER_FETCH 0\n";
    prolog += is_separate(parameters) ? "#define SHEER_SEPARATE_ALPHA 1\n" : "#define SHEER_SEPARATE_ALPHA 0\n";
    prolog += parameters.form == DiscardingParameters::Form::if_else ? "#define SHEER_IF_ELSE 1\n"
                                                                     : "#define SHEER_IF_ELSE 0\n";
    return setup.scene.make_program("f2bd", gl::shader_file("methods/f2bd.glsl"), prolog + parameters.prolog());
}

}  // namespace

ParamTable<DiscardingParameters> DiscardingParameters::table() {
    return ParamTable<DiscardingParameters>()
        .number(&DiscardingParameters::threshold, "threshold",
                "a fragment is discarded if less than this transmittance is left", "", 0, 1)
        .choice(
            &DiscardingParameters::sync, "sync",
            "how the caches are made to see the clear and each batch: with a texture barrier, by binding framebuffer 0 "
            "and back, with glFlush or glFinish (which do not help according to the paper), or not at all (shows the "
            "artefacts of its Figure 3 on hardware)",
            {{"barrier", Sync::barrier},
             {"rebind", Sync::rebind},
             {"flush", Sync::flush},
             {"finish", Sync::finish},
             {"none", Sync::none}})
        .choice(&DiscardingParameters::alpha_target, "alpha_target",
                "read the transmittance from the color target or from a separate target with one channel",
                {{"shared", AlphaTarget::shared}, {"separate", AlphaTarget::separate}})
        .choice(&DiscardingParameters::feedback, "feedback", "how the fragment reads it",
                {{"texture", Feedback::texture}, {"framebuffer_fetch", Feedback::framebuffer_fetch}})
        .integer(&DiscardingParameters::batch, "batch",
                 "primitives between synchronisations; 0 synchronises only after the clear", "", 0, 1000000)
        .choice(&DiscardingParameters::form, "form",
                "form of the shader: discard or else shade, as the paper prints it, or discard and continue, which it "
                "found slower on some hardware",
                {{"if_else", Form::if_else}, {"if_discard", Form::if_discard}})
        .with(AlphaForm::table());
}

std::optional<double> discarding_bytes_per_px(const DiscardingParameters& parameters, int pixel_bytes) {
    return (is_separate(parameters) ? 1.25 : 1.0) * pixel_bytes;
}

DiscardingBlending::DiscardingBlending(const MethodSetup& setup, const DiscardingParameters& parameters,
                                       float initial_transmittance)
    : OpaqueFirst(setup),
      m_parameters(parameters),
      m_initial_transmittance(initial_transmittance),
      m_accumulation(setup.gl, setup.target, setup.target.format(), is_separate(parameters), parameters),
      m_program(make_program(setup, parameters)) {
    m_program.set("u_threshold", static_cast<float>(parameters.threshold));
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
        const Pass drawing = m_accumulation.blending();
        if (!fetches(m_parameters)) m_program.set_texture("u_alpha", m_accumulation.readable_alpha());
        draw_batches();
    }
    const auto pass = timer.pass("composite", gl::Phase::finalization);
    m_accumulation.composite();
}

void DiscardingBlending::draw_batches() const {
    const std::size_t count = m_scene.transparent_count();
    const std::size_t step = m_parameters.batch == 0 ? std::max<std::size_t>(count, 1) : m_parameters.batch;
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
        fragments_fact("discarded", discarded, "The fragments that were discarded before they were shaded."),
        fragment_fact("saturated_at", discarded.empty() ? std::nullopt : draws.last_passed(),
                      "The fragment after which less than the threshold was left; none if nothing was discarded, or "
                      "if all was.")};
    add_accumulated(facts, draws.color, m_accumulation.form());
    return facts;
}

void DiscardingBlending::synchronise() const {
    using Sync = DiscardingParameters::Sync;
    switch (m_parameters.sync) {
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
