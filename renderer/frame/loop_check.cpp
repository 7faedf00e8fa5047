#include "renderer/frame/loop_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/errors.h"
#include "renderer/frame/count_image.h"
#include "renderer/methods/method.h"
#include "renderer/scene/glsl_shading.h"

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

void render_untimed(Method& method, gl::FrameTimer& timer) {
    timer.begin_frame(false);
    try {
        method.render(timer);
    } catch (...) {
        timer.end_frame();
        throw;
    }
    timer.end_frame();
}

}  // namespace

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

void check_loops_of(const MethodSpec& spec, const gl::Context& context, Scene& scene, const Target& target,
                    gl::FrameTimer& timer) {
    if (!scene.counts_iterations()) return;
    const gl::Functions& gl = context.gl();
    std::uint32_t any_refused = 0;
    const gl::Buffer report = gl::make_buffer(gl, "loop report", sizeof any_refused, &any_refused);
    const LoopsReported reported(scene);
    try {
        const auto method = find_method(spec.id)->make({context, gl, scene, target, spec.parameters});
        gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, loop_report_binding, report.id());
        render_untimed(*method, timer);
    } catch (const Unsupported&) {
        return;
    } catch (const RenderError&) {
        return;  // it fails again where it is drawn, and is told there
    }
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl.GetNamedBufferSubData(report.id(), 0, sizeof any_refused, &any_refused);
    if (any_refused == 0) return;
    throw SpecError(std::vector<FieldError>{
        {glsl_shading_pointer, fmt::format("the loops of a fragment do not end within {} iterations where {} draws it",
                                           iterations_per_fragment, spec.label.empty() ? spec.id : spec.label)}});
}

}  // namespace sheer
