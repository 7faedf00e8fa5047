#include "renderer/methods/shared/stencil_cap.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "renderer/passes/texel.h"

namespace sheer {

namespace {

constexpr int coarse_factor = 4;

gl::Program cap_program(const MethodSetup& setup, double min_alpha, const std::string& label, std::string_view path) {
    std::string prolog = min_alpha > 0 ? "#define SHEER_ALPHA_TEST 1\n"
                                       : "#define SHEER_ALPHA_TEST 0\nlayout(early_fragment_tests) in;\n";
    prolog += setup.scene.has_opaque() ? "#define SHEER_HAS_OPAQUE 1\n" : "#define SHEER_HAS_OPAQUE 0\n";
    gl::Program program = setup.scene.make_program(label, gl::shader_file(path), prolog);
    program.set("u_least_alpha", setup.scene.least_alpha(min_alpha));
    return program;
}

double greatest_change(const Image& before, const Image& after) {
    double greatest = 0;
    for (std::size_t i = 0; i < after.rgba.size(); ++i)
        if (i % 4 != 3) greatest = std::max(greatest, std::abs(double{after.rgba[i]} - before.rgba[i]));
    return greatest;
}

}  // namespace

ParamTable<StencilCapParameters> StencilCapParameters::table() {
    return ParamTable<StencilCapParameters>()
        .integer(&StencilCapParameters::layers, "layers", "fragments that are drawn in a pixel", "", 1, 254)
        .number(&StencilCapParameters::min_alpha, "min_alpha",
                "fragments with less alpha are dropped and do not use up a layer", "", 0, 1)
        .integer(&StencilCapParameters::frames, "frames",
                 "the picture is that of this frame; the first frame has no previous one", "frames", 1, 1000)
        .boolean(&StencilCapParameters::zcull, "zcull",
                 "a pass at a quarter of the size primes the depth buffer with the depth at which each pixel is full");
}

StencilCap::StencilCap(const MethodSetup& setup, const StencilCapParameters& parameters)
    : OpaqueFirst(setup),
      m_layers(parameters.layers),
      m_frames(parameters.frames),
      m_zcull(parameters.zcull),
      m_tests_alpha(parameters.min_alpha > 0),
      m_counts(!m_tests_alpha && (setup.scene.has_opaque() || m_zcull)),
      m_coarse_width_px((setup.target.width_px() + coarse_factor - 1) / coarse_factor),
      m_coarse_height_px((setup.target.height_px() + coarse_factor - 1) / coarse_factor),
      m_accumulation(setup.gl, setup.target, setup.target.format()),
      m_depth(setup.gl, setup.target, m_accumulation.readable_alpha().id(), GL_DEPTH32F_STENCIL8),
      m_fill(setup.gl, "stencil cap: fill", gl::shader_file("methods/stencil_cap_fill.glsl"),
             m_counts ? "#define SHEER_COUNTED 1\n" : "#define SHEER_COUNTED 0\n"),
      m_program(cap_program(setup, parameters.min_alpha, "stencil cap", "methods/stencil_cap.glsl")),
      m_previous(history_texture()),
      m_current(history_texture()) {
    if (m_counts) make_counts(setup);
    if (!m_zcull) return;
    m_coarse_program =
        cap_program(setup, parameters.min_alpha, "stencil cap: coarse depth", "methods/stencil_cap_depth.glsl");
    m_prime = gl::Program(m_gl, "stencil cap: prime", gl::shader_file("methods/stencil_cap_prime.vert.glsl"),
                          glsl_version + std::string(gl::shader_file("methods/stencil_cap_prime.glsl")));
    m_coarse_depth = gl::make_texture_2d(m_gl, "stencil cap: coarse depth", GL_DEPTH32F_STENCIL8, m_coarse_width_px,
                                         m_coarse_height_px);
    m_coarse = gl::make_framebuffer(m_gl, "stencil cap: coarse", std::span<const GLuint>(), m_coarse_depth.id());
    m_no_vertices = gl::make_vertex_array(m_gl, "stencil cap: no vertices");
}

void StencilCap::make_counts(const MethodSetup& setup) {
    m_count_program = setup.scene.make_program("stencil cap: count", gl::shader_file("common/count.glsl"));
    // Half floats represent whole numbers exactly up to 2,048.
    m_count = m_target.make_texture("stencil cap: count", GL_R16F);
    m_count_framebuffer =
        gl::make_framebuffer(m_gl, "stencil cap: count", std::array{m_count.id()}, m_target.depth().id());
    m_fill.program().set("u_cap", static_cast<float>(m_layers));
}

gl::Texture StencilCap::history_texture() const {
    const int width = m_target.width_px(), height = m_target.height_px();
    gl::Texture texture = gl::make_texture_2d(m_gl, "stencil cap: frame", gl_format(m_target.format()), width, height,
                                              std::max(width, height) > 1 ? 2 : 1);
    m_gl.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    return texture;
}

void StencilCap::render(gl::FrameTimer& timer) {
    do {
        if (m_frame < m_frames) advance();
        draw_frame(timer);
    } while (m_frame < m_frames);
}

nlohmann::json StencilCap::findings(gl::FrameTimer& timer) {
    return {{"change_per_frame", change_per_frame(timer)}};
}

std::vector<double> StencilCap::change_per_frame(gl::FrameTimer& timer) {
    std::vector<double> changes;
    Image before;
    restart();
    while (m_frame < m_frames) {
        advance();
        draw_frame(timer);
        Image after = m_target.read();
        if (m_frame > 1) changes.push_back(greatest_change(before, after));
        before = std::move(after);
    }
    return changes;
}

void StencilCap::advance() {
    std::swap(m_previous, m_current);
    ++m_frame;
}

void StencilCap::draw_frame(gl::FrameTimer& timer) const {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("clear", gl::Phase::initialization);
        m_accumulation.clear(1);
        m_depth.copy_opaque();
    }
    if (m_zcull) {
        const auto pass = timer.pass("zcull", gl::Phase::initialization);
        prime_depth();
    }
    {
        const auto pass = timer.pass("transparent", gl::Phase::transparent);
        draw_capped();
    }
    if (m_counts) {
        const auto pass = timer.pass("count", gl::Phase::transparent);
        count_fragments();
    }
    const auto pass = timer.pass("fill and composite", gl::Phase::finalization);
    if (m_frame > 1) fill();
    m_accumulation.composite();
    keep_picture();
}

/// The stencil is equal to layers - 1 for one fragment only, whose depth is kept. Slanted primitives are moved back by
/// their slope over a coarse pixel, so that none of their finer pixels is behind it.
void StencilCap::prime_depth() const {
    {
        Pass drawing(m_gl, m_coarse, m_coarse_width_px, m_coarse_height_px);
        drawing.clear_depth(1);
        drawing.clear_stencil(0);
        drawing.depth_test(GL_ALWAYS);
        drawing.stencil(GL_EQUAL, m_layers - 1, GL_INCR, GL_INCR, GL_INCR);
        drawing.polygon_offset(1, 0);
        m_scene.draw_transparent(m_coarse_program, Order::near_to_far);
    }
    Pass priming = m_depth.depth_only();
    priming.depth_test(GL_LESS);
    m_prime.set_texture("u_coarse_depth", m_coarse_depth);
    m_prime.use();
    m_gl.BindVertexArray(m_no_vertices.id());
    m_gl.DrawArrays(GL_TRIANGLES, 0, 6 * m_coarse_width_px * m_coarse_height_px);
}

void StencilCap::draw_capped() const {
    Pass drawing = m_depth.blending();
    drawing.transparent_depth();
    // Fragments that the cap stops are counted too, unless a separate pass counts them.
    drawing.stencil(GL_GREATER, m_layers, m_counts ? GL_KEEP : GL_INCR, GL_KEEP, GL_INCR);
    m_program.set_texture("u_opaque_depth", m_target.depth());
    m_scene.draw_transparent(m_program, Order::near_to_far);
}

/// Counts without shading. The stencil test stops a fragment before the depth test shows whether opaque geometry or
/// zcull hides it, and with early tests no shader can find out either.
void StencilCap::count_fragments() const {
    Pass drawing = begin(m_count_framebuffer);
    drawing.clear_color(glm::vec4(0));
    drawing.transparent_depth();
    drawing.blend(GL_ONE, GL_ONE);
    m_scene.draw_transparent(m_count_program, Order::near_to_far);
}

/// Only pixels in which the cap hides something: behind the others the opaque picture is visible.
void StencilCap::fill() const {
    Pass drawing = m_depth.blending();
    drawing.stencil(m_counts ? GL_EQUAL : GL_LESS, m_layers, GL_KEEP, GL_KEEP, GL_KEEP);
    set_fill_textures();
    m_fill.draw();
}

void StencilCap::set_fill_textures() const {
    m_fill.program().set_texture("u_previous", m_previous);
    if (m_counts) m_fill.program().set_texture("u_count", m_count);
}

std::vector<PixelFact> StencilCap::explain(const PixelTrace& trace) const {
    const PixelTrace::Draws draws = trace.of(m_program);
    const int x = trace.x(), y = trace.y(), counted = m_depth.read(x, y).stencil;
    const std::vector<std::size_t> let_through = draws.passed();
    std::vector<std::size_t> faint, cut;
    for (const std::size_t number : draws.failed())
        (counted >= m_layers && !let_through.empty() && number > let_through.back() ? cut : faint).push_back(number);
    std::vector<PixelFact> facts = {
        fragments_fact("let_through", let_through, "The fragments that were blended, near to far."),
        fragments_fact("dropped", faint,
                       m_zcull ? "The fragments under min_alpha, or behind the depth that the coarse pass left."
                               : "The fragments under min_alpha, which do not use up a layer."),
        fragments_fact("cut", cut, "The fragments behind the cap."),
        number_fact("stencil", counted, "How many fragments the stencil counted; more than the cap if it counts on.")};
    add_accumulated(facts, draws.color);
    const bool cuts = m_counts ? read_texel(m_gl, m_count, x, y).r > static_cast<float>(m_layers) : counted > m_layers;
    const bool filled = m_frame > 1 && cuts;
    set_fill_textures();
    const glm::vec3 fill_color(shade_texel(m_gl, m_fill, m_target, x, y));
    facts.push_back(color_fact("fill", fill_color,
                               filled ? "The color of the previous frame's copy behind them."
                                      : "The color that the previous frame's copy would give; not drawn, since the cap "
                                        "hides nothing here or there is no previous frame."));
    return facts;
}

void StencilCap::keep_picture() const {
    m_gl.CopyImageSubData(m_target.color().id(), GL_TEXTURE_2D, 0, 0, 0, 0, m_current.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                          m_target.width_px(), m_target.height_px(), 1);
    m_gl.GenerateTextureMipmap(m_current.id());
}

std::int64_t StencilCap::memory_bytes() const {
    return gl::memory_bytes_of(m_accumulation, m_depth, m_previous, m_current, m_coarse_depth, m_count);
}

}  // namespace sheer
