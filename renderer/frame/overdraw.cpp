#include "renderer/frame/overdraw.h"

#include <array>

namespace sheer {

PixelCounts count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer) {
    const int width = target.width_px(), height = target.height_px();
    const gl::Texture counter = gl::make_texture_2d(gl, "overdraw", GL_R32F, width, height);
    const gl::Framebuffer framebuffer =
        gl::make_framebuffer(gl, "overdraw", std::array{counter.id()}, target.depth().id());
    const gl::Program program = scene.make_program("overdraw", gl::shader_file("common/count.glsl"));
    OpaquePass(gl, scene, target).draw(timer);
    {
        const auto pass = timer.pass("overdraw", gl::Phase::transparent);
        begin_pass(gl, framebuffer, width, height);
        const glm::vec4 zero(0);
        gl.ClearBufferfv(GL_COLOR, 0, &zero[0]);
        set_transparent_depth_state(gl);
        gl.Enable(GL_BLEND);
        gl.BlendFunc(GL_ONE, GL_ONE);
        scene.draw_transparent(program, Order::submission);
    }
    std::vector<float> values(static_cast<std::size_t>(width) * height);
    gl.GetTextureImage(counter.id(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)),
                       values.data());
    return {width, height, std::vector<std::uint32_t>(values.begin(), values.end())};
}

}  // namespace sheer
