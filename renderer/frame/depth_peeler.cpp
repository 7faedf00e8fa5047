#include "renderer/frame/depth_peeler.h"

#include <array>

namespace sheer {

namespace {

constexpr GLuint unit_depth = first_method_texture_unit + 1, unit_last_depth = unit_depth + 1,
                 unit_last_primitive = unit_depth + 2;

}  // namespace

DepthPeeler::DepthPeeler(const gl::Functions& gl, const Scene& scene, const Target& target)
    : m_gl(gl),
      m_scene(scene),
      m_target(target),
      m_peel(scene.make_program("depth peeling: peel", gl::shader_file("methods/depth_peeling_peel.glsl"))),
      m_any_fragment(gl::make_query(gl, "depth peeling: any fragment", GL_ANY_SAMPLES_PASSED)),
      m_depth(texture("depth", GL_DEPTH_COMPONENT32F)) {
    for (Layer& layer : m_layers) {
        layer.color = texture("color", GL_RGBA32F);
        layer.depth = texture("fragment depth", GL_R32F);
        layer.primitive = texture("fragment primitive", GL_R32UI);
        layer.framebuffer =
            gl::make_framebuffer(m_gl, "depth peeling: layer",
                                 std::array{layer.color.id(), layer.depth.id(), layer.primitive.id()}, m_depth.id());
    }
}

std::int64_t DepthPeeler::memory_bytes() const {
    return std::int64_t{m_target.width_px()} * m_target.height_px() * (2 * 24 + 4);
}

gl::Texture DepthPeeler::texture(const std::string& what, GLenum format) const {
    return gl::make_texture_2d(m_gl, "depth peeling: " + what, format, m_target.width_px(), m_target.height_px());
}

/// `depth` is what the next pass finds where this one keeps nothing: -1 is before everything, 2 behind everything.
void DepthPeeler::clear(const Layer& layer, float depth) const {
    begin_pass(m_gl, layer.framebuffer, m_target.width_px(), m_target.height_px());
    const glm::vec4 no_color(0), no_depth(depth);
    const glm::uvec4 no_primitive(0);
    const float far_depth = 1;
    m_gl.ClearBufferfv(GL_COLOR, 0, &no_color[0]);
    m_gl.ClearBufferfv(GL_COLOR, 1, &no_depth[0]);
    m_gl.ClearBufferuiv(GL_COLOR, 2, &no_primitive[0]);
    m_gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
}

void DepthPeeler::begin() {
    clear(m_layers[m_current], -1);
}

/// Drawn in submission order with LEQUAL, so that of equal depths the later submitted wins, which is the one that
/// counts as nearer.
bool DepthPeeler::next() {
    const Layer& last = m_layers[m_current];
    m_current = 1 - m_current;
    clear(m_layers[m_current], 2);
    m_gl.Enable(GL_DEPTH_TEST);
    m_gl.DepthFunc(GL_LEQUAL);
    m_gl.BindTextureUnit(unit_depth, m_target.depth().id());
    m_gl.BindTextureUnit(unit_last_depth, last.depth.id());
    m_gl.BindTextureUnit(unit_last_primitive, last.primitive.id());
    m_gl.BeginQuery(GL_ANY_SAMPLES_PASSED, m_any_fragment.id());
    m_scene.draw_transparent(m_peel, Order::submission);
    m_gl.EndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint any = 0;
    m_gl.GetQueryObjectuiv(m_any_fragment.id(), GL_QUERY_RESULT, &any);
    return any != 0;
}

double peeled_fragments(const PixelCounts& overdraw) {
    return static_cast<double>(overdraw.total()) * (overdraw.greatest() + 1.0);
}

}  // namespace sheer
