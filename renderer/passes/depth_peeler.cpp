#include "renderer/passes/depth_peeler.h"

#include <array>

namespace sheer {

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
    std::int64_t sum = m_depth.memory_bytes();
    for (const Layer& layer : m_layers) sum += gl::memory_bytes_of(layer.color, layer.depth, layer.primitive);
    return sum;
}

gl::Texture DepthPeeler::texture(const std::string& what, GLenum format) const {
    return m_target.make_texture("depth peeling: " + what, format);
}

/// `depth` is what the next pass finds where this one keeps nothing: -1 is in front of everything, 2 behind everything.
Pass DepthPeeler::begin_layer(const Layer& layer, float depth) const {
    Pass drawing(m_gl, layer.framebuffer, m_target.width_px(), m_target.height_px());
    drawing.clear_color(glm::vec4(0));
    drawing.clear_color(glm::vec4(depth), 1);
    drawing.clear_color(glm::uvec4(0), 2);
    drawing.clear_depth(1);
    return drawing;
}

void DepthPeeler::begin() {
    begin_layer(m_layers[m_current], -1);
}

/// Drawn in submission order with LEQUAL, so that of equal depths the one submitted later wins, which counts as nearer.
bool DepthPeeler::next() {
    const Layer& last = m_layers[m_current];
    m_current = 1 - m_current;
    Pass drawing = begin_layer(m_layers[m_current], 2);
    drawing.depth_test(GL_LEQUAL);
    m_peel.set_texture("u_opaque_depth", m_target.depth());
    m_peel.set_texture("u_last_depth", last.depth);
    m_peel.set_texture("u_last_primitive", last.primitive);
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
