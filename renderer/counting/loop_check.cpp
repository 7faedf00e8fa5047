#include "renderer/counting/loop_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/errors.h"
#include "renderer/counting/count_image.h"
#include "renderer/glsl/own_shading.h"
#include "renderer/passes/pass.h"

namespace sheer {

namespace {

class LoopsReported {
  public:
    explicit LoopsReported(Scene& scene) : m_scene(scene) { m_scene.report_loops(true); }
    ~LoopsReported() { m_scene.report_loops(false); }
    LoopsReported(const LoopsReported&) = delete;
    LoopsReported& operator=(const LoopsReported&) = delete;

  private:
    Scene& m_scene;
};

}  // namespace

void check_loops(const gl::Functions& gl, const Scene& scene, const ImageSpec& image) {
    if (!scene.counts_iterations()) return;
    const Target target(gl, image, PixelFormat::rgba8);
    const CountImage refused(gl, "fragments out of iterations", image.width_px, image.height_px);
    const gl::Program program = scene.make_program("loops", gl::shader_file("scenes/check_loops.glsl"));
    {
        Pass drawing(gl, target);
        drawing.no_color();
        refused.bind();
        program.set("u_opaque", 1);
        scene.draw_opaque(program);
        program.set("u_opaque", 0);
        scene.draw_transparent(program, Order::submission);
    }

    const std::vector<std::uint32_t> counts = refused.read().counts;
    const auto first = std::ranges::find_if(counts, [](std::uint32_t count) { return count > 0; });
    if (first == counts.end()) return;
    const auto pixel = first - counts.begin();
    const auto pixels = std::ranges::count_if(counts, [](std::uint32_t count) { return count > 0; });
    throw SpecError(std::vector<FieldError>{
        {scene.glsl_pointer(),
         fmt::format("the loops of a fragment at pixel ({}, {}) do not end within {} iterations; {} pixels have such "
                     "fragments",
                     pixel % image.width_px, pixel / image.width_px, iterations_per_fragment, pixels)}});
}

void check_loops_of(const std::string& name, const gl::Functions& gl, Scene& scene, const std::function<void()>& draw) {
    if (!scene.counts_iterations()) return;
    std::uint32_t any_refused = 0;
    const gl::Buffer report = gl::make_buffer(gl, "loop report", sizeof any_refused, &any_refused);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, loop_report_binding, report.id());
    const LoopsReported reported(scene);
    try {
        draw();
    } catch (const Unsupported&) {
        return;
    } catch (const RenderError&) {
        return;
    }
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl.GetNamedBufferSubData(report.id(), 0, sizeof any_refused, &any_refused);
    if (any_refused == 0) return;
    throw SpecError(std::vector<FieldError>{
        {scene.glsl_pointer(), fmt::format("the loops of a fragment do not end within {} iterations when {} draws it",
                                           iterations_per_fragment, name)}});
}

}  // namespace sheer
