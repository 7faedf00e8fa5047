#include "renderer/passes/overdraw.h"

#include <array>

#include "renderer/passes/pass.h"

namespace sheer {

namespace {

/// Adds up the output of `shader` for each transparent fragment by blending in 32-bit floats: exact up to 2^24 of them
/// per pixel.
PixelCounts count_by(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer,
                     std::string_view shader, bool hidden_by_opaque) {
    const int width = target.width_px(), height = target.height_px();
    const gl::Texture counter = gl::make_texture_2d(gl, "overdraw", GL_R32F, width, height);
    const gl::Framebuffer framebuffer =
        gl::make_framebuffer(gl, "overdraw", std::array{counter.id()}, target.depth().id());
    const gl::Program program = scene.make_program("overdraw", gl::shader_file(shader));
    if (hidden_by_opaque) OpaquePass(gl, scene, target).draw(timer);
    {
        const auto pass = timer.pass("overdraw", gl::Phase::transparent);
        Pass drawing(gl, framebuffer, width, height);
        drawing.clear_color(glm::vec4(0));
        if (!hidden_by_opaque) drawing.clear_depth(1);
        drawing.transparent_depth();
        drawing.blend(GL_ONE, GL_ONE);
        scene.draw_transparent(program, Order::submission);
    }
    std::vector<float> values(static_cast<std::size_t>(width) * height);
    gl.GetTextureImage(counter.id(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)),
                       values.data());
    return {width, height, std::vector<std::uint32_t>(values.begin(), values.end())};
}

}  // namespace

PixelCounts count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer) {
    return count_by(gl, scene, target, timer, "common/count.glsl", true);
}

PixelCounts count_visible(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer) {
    return count_by(gl, scene, target, timer, "common/count_visible.glsl", true);
}

PixelCounts count_behind_opaque(const gl::Functions& gl, const Scene& scene, const Target& target,
                                gl::FrameTimer& timer) {
    return count_by(gl, scene, target, timer, "common/count.glsl", false);
}

}  // namespace sheer
