#include "renderer/passes/multisample.h"

#include <algorithm>
#include <array>
#include <vector>

#include "renderer/passes/pass.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

std::vector<GLint> sample_counts(const gl::Functions& gl, GLenum format) {
    GLint count = 0;
    gl.GetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_NUM_SAMPLE_COUNTS, 1, &count);
    std::vector<GLint> counts(static_cast<std::size_t>(count));
    gl.GetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_SAMPLES, count, counts.data());
    return counts;
}

int fewest_samples(const gl::Functions& gl, GLenum color_format, int wanted) {
    const std::vector<GLint> of_color = sample_counts(gl, color_format),
                             of_depth = sample_counts(gl, GL_DEPTH_COMPONENT32F);
    int fewest = 0;
    for (const GLint samples : of_color)
        if (samples >= wanted && std::ranges::count(of_depth, samples) > 0 && (fewest == 0 || samples < fewest))
            fewest = samples;
    if (fewest == 0)
        throw Unsupported("this device does not have " + std::to_string(wanted) +
                          " or more samples per pixel in this format");
    return fewest;
}

}  // namespace

Multisample::Multisample(const gl::Functions& gl, const Target& target, int samples)
    : m_gl(gl),
      m_target(target),
      m_samples(fewest_samples(gl, gl_format(target.format()), samples)),
      m_color(gl::make_texture_2d_multisample(gl, "multisample color", gl_format(target.format()), target.width_px(),
                                              target.height_px(), m_samples)),
      m_depth(gl::make_texture_2d_multisample(gl, "multisample depth", GL_DEPTH_COMPONENT32F, target.width_px(),
                                              target.height_px(), m_samples)),
      m_framebuffer(gl::make_framebuffer(gl, "multisample", std::array{m_color.id()}, m_depth.id())) {}

std::vector<Multisample::Sample> Multisample::read(int x, int y) const {
    const FullscreenPass one_sample(m_gl, "one sample", gl::shader_file("common/one_sample.glsl"));
    std::vector<Sample> samples;
    one_sample.program().set_texture("u_color", m_color);
    one_sample.program().set_texture("u_depth", m_depth);
    for (int i = 0; i < m_samples; ++i) {
        one_sample.program().set("u_sample", i);
        samples.push_back(
            {shade_texel(m_gl, one_sample, m_target, x, y, 0), shade_texel(m_gl, one_sample, m_target, x, y, 1).r});
    }
    return samples;
}

void Multisample::resolve_color() const {
    const int width = m_target.width_px(), height = m_target.height_px();
    const Pass drawing(m_gl, m_target);
    m_gl.BlitNamedFramebuffer(m_framebuffer.id(), m_target.framebuffer().id(), 0, 0, width, height, 0, 0, width, height,
                              GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace sheer
