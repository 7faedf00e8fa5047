#include "renderer/counting/needed.h"

#include <fmt/format.h>

#include "renderer/core/number_text.h"
#include "renderer/counting/count_image.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/depth_peeler.h"

namespace sheer {

namespace {

/// Every primitive costs a draw and a barrier.
constexpr std::size_t most_primitives = 100000;

/// The count of needed fragments of each pixel in which less than the threshold is left.
PixelCounts saturation_layers(const gl::Functions& gl, const Accumulation& accumulation, PixelCounts needed,
                              float threshold) {
    std::vector<float> rgba(needed.counts.size() * 4);
    gl.GetTextureImage(accumulation.readable_alpha().id(), 0, GL_RGBA, GL_FLOAT,
                       static_cast<GLsizei>(rgba.size() * sizeof(float)), rgba.data());
    for (std::size_t i = 0; i < needed.counts.size(); ++i)
        if (rgba[4 * i + 3] >= threshold) needed.counts[i] = 0;
    return needed;
}

void count_by_primitive(const gl::Functions& gl, const Scene& scene, const Accumulation& accumulation,
                        float threshold) {
    const gl::Program program = scene.make_program("needed fragments", gl::shader_file("common/count_needed.glsl"),
                                                   "layout(early_fragment_tests) in;\n");
    program.set("u_threshold", threshold);
    const Pass drawing = accumulation.blending();
    program.set_texture("u_alpha", accumulation.readable_alpha());
    for (std::size_t i = 0; i < scene.transparent_count(); ++i) {
        gl.TextureBarrier();
        scene.draw_transparent(program, Order::near_to_far, i, 1);
    }
}

void count_by_layer(const gl::Functions& gl, const Scene& scene, const Target& target, const Accumulation& accumulation,
                    float threshold) {
    const FullscreenPass count(gl, "needed fragments", gl::shader_file("common/count_needed_layer.glsl"));
    count.program().set("u_threshold", threshold);
    DepthPeeler peeler(gl, scene, target);
    peeler.begin();
    while (peeler.next()) {
        Pass drawing = accumulation.blending();
        drawing.no_depth_test();
        gl.TextureBarrier();
        count.program().set_texture("u_alpha", accumulation.readable_alpha());
        count.program().set_texture("u_layer_depth", peeler.depth());
        count.program().set_texture("u_layer", peeler.color());
        count.draw();
    }
}

}  // namespace

std::string why_needed_is_unknown(const Scene& scene, const PixelCounts& overdraw) {
    if (!scene.parallel()) {
        const double peeled = peeled_fragments(overdraw);
        if (peeled <= max_peeled_fragments) return "";
        return fmt::format("primitives may intersect, and peeling them would draw {} fragments; the limit is {}",
                           number_text(peeled), number_text(max_peeled_fragments));
    }
    if (scene.transparent_count() > most_primitives)
        return "each primitive must be drawn separately, and there are over " + std::to_string(most_primitives);
    return "";
}

NeededFragments count_needed(const gl::Functions& gl, const Scene& scene, const Target& target, float threshold,
                             gl::FrameTimer& timer) {
    const CountImage image(gl, "needed fragments", target.width_px(), target.height_px());
    const Accumulation accumulation(gl, target, target.format());
    OpaquePass(gl, scene, target).draw(timer);
    const auto pass = timer.pass("needed fragments", gl::Phase::transparent);
    accumulation.clear(1);
    image.bind();
    if (scene.parallel()) {
        count_by_primitive(gl, scene, accumulation, threshold);
    } else {
        count_by_layer(gl, scene, target, accumulation, threshold);
    }
    NeededFragments result{image.read(), {}};
    result.saturation = saturation_layers(gl, accumulation, result.needed, threshold);
    return result;
}

}  // namespace sheer
