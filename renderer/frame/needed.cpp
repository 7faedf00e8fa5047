#include "renderer/frame/needed.h"

#include "renderer/frame/accumulation.h"
#include "renderer/frame/count_image.h"

namespace sheer {

namespace {

/// Every primitive costs a draw and a barrier.
constexpr std::size_t most_primitives = 100000;

/// Where the accumulation has less than the threshold left, the count of needed fragments.
PixelCounts saturation_layers(const gl::Functions& gl, const Accumulation& accumulation, PixelCounts needed,
                              float threshold) {
    std::vector<float> rgba(needed.counts.size() * 4);
    gl.GetTextureImage(accumulation.readable_alpha().id(), 0, GL_RGBA, GL_FLOAT,
                       static_cast<GLsizei>(rgba.size() * sizeof(float)), rgba.data());
    for (std::size_t i = 0; i < needed.counts.size(); ++i)
        if (rgba[4 * i + 3] >= threshold) needed.counts[i] = 0;
    return needed;
}

}  // namespace

std::string why_needed_is_unknown(const Scene& scene) {
    if (!scene.parallel()) return "primitives may intersect, so that no order of whole primitives is the exact one";
    if (scene.transparent_count() > most_primitives)
        return "each primitive must be drawn by itself, and there are over " + std::to_string(most_primitives);
    return "";
}

NeededFragments count_needed(const gl::Functions& gl, const Scene& scene, const Target& target, float threshold,
                             gl::FrameTimer& timer) {
    const CountImage image(gl, "needed fragments", target.width_px(), target.height_px());
    const Accumulation accumulation(gl, target, target.format());
    const gl::Program program = scene.make_program("needed fragments", gl::shader_file("common/count_needed.glsl"),
                                                   "layout(early_fragment_tests) in;\n");
    program.set("u_threshold", threshold);
    OpaquePass(gl, scene, target).draw(timer);
    const auto pass = timer.pass("needed fragments", gl::Phase::transparent);
    accumulation.clear(1);
    accumulation.begin_blending();
    gl.BindTextureUnit(first_method_texture_unit, accumulation.readable_alpha().id());
    image.bind();
    for (std::size_t i = 0; i < scene.transparent_count(); ++i) {
        gl.TextureBarrier();
        scene.draw_transparent(program, Order::near_to_far, i, 1);
    }
    NeededFragments result{image.read(), {}};
    result.saturation = saturation_layers(gl, accumulation, result.needed, threshold);
    return result;
}

}  // namespace sheer
