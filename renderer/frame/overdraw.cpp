#include "renderer/frame/overdraw.h"

#include <algorithm>
#include <array>

namespace sheer {

std::uint64_t Overdraw::total() const {
    return total_in(0, 0, width_px, height_px);
}

std::uint32_t Overdraw::greatest() const {
    return counts.empty() ? 0 : *std::ranges::max_element(counts);
}

std::uint64_t Overdraw::total_in(int x0, int y0, int x1, int y1) const {
    std::uint64_t sum = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) sum += counts[static_cast<std::size_t>(y) * width_px + x];
    return sum;
}

Overdraw count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer) {
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
