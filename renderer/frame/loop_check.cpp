#include "renderer/frame/loop_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/errors.h"
#include "renderer/frame/count_image.h"
#include "renderer/frame/target.h"
#include "renderer/scene/glsl_shading.h"

namespace sheer {

void check_loops(const gl::Functions& gl, const Scene& scene, const ImageSpec& image) {
    if (!scene.counts_iterations()) return;
    const Target target(gl, image, PixelFormat::rgba8);
    const CountImage refused(gl, "fragments out of iterations", image.width_px, image.height_px);
    const gl::Program program = scene.make_program("loops", gl::shader_file("scenes/check_loops.glsl"));
    begin_pass(gl, target.framebuffer(), image.width_px, image.height_px);
    gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    refused.bind();
    program.set("u_opaque", 1);
    scene.draw_opaque(program);
    program.set("u_opaque", 0);
    scene.draw_transparent(program, Order::submission);

    const std::vector<std::uint32_t> counts = refused.read().counts;
    const auto first = std::ranges::find_if(counts, [](std::uint32_t count) { return count > 0; });
    if (first == counts.end()) return;
    const auto pixel = first - counts.begin();
    const auto pixels = std::ranges::count_if(counts, [](std::uint32_t count) { return count > 0; });
    throw SpecError(std::vector<FieldError>{
        {glsl_shading_pointer,
         fmt::format("the loops of a fragment at pixel ({}, {}) do not end within {} iterations; {} pixels have such "
                     "fragments",
                     pixel % image.width_px, pixel / image.width_px, iterations_per_fragment, pixels)}});
}

}  // namespace sheer
