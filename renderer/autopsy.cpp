#include "renderer/autopsy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <tuple>

#include "renderer/frame/loop_check.h"
#include "renderer/frame/target.h"

namespace sheer {

namespace {

constexpr std::uint32_t words_per_fragment = 6;  // as in shaders/common/autopsy.glsl
constexpr std::uint32_t first_capacity = 1024;   // fragments that are kept without counting them first

class Autopsy {
  public:
    Autopsy(gl::Context& context, const Scene& scene, const Target& target, int x, int y)
        : m_context(context), m_gl(context.gl()), m_scene(scene), m_target(target), m_x(x), m_y(y) {}

    PixelStack run() {
        gl::FrameTimer timer(m_context);
        timer.begin_frame(false);
        OpaquePass(m_gl, m_scene, m_target).draw(timer);
        PixelStack stack;
        for (int i = 0; i < 3; ++i) stack.background[i] = m_target.background()[i];
        stack.opaque = read_opaque();
        stack.fragments = collect(timer);
        timer.end_frame();
        m_context.check("taking a pixel apart");
        return stack;
    }

  private:
    std::optional<OpaqueFragment> read_opaque() const {
        float depth = 1;
        std::array<float, 4> color{};
        m_gl.BindFramebuffer(GL_FRAMEBUFFER, m_target.framebuffer().id());
        m_gl.ReadPixels(m_x, m_y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
        m_gl.ReadPixels(m_x, m_y, 1, 1, GL_RGBA, GL_FLOAT, color.data());
        if (depth >= 1) return std::nullopt;
        return OpaqueFragment{depth, {color[0], color[1], color[2]}};
    }

    std::vector<PixelFragment> collect(gl::FrameTimer& timer) const {
        const gl::Program program = m_scene.make_program("autopsy", gl::shader_file("common/autopsy.glsl"));
        std::vector<std::uint32_t> words(std::size_t{first_capacity} * words_per_fragment);
        std::uint32_t count = draw(program, words, timer);
        if (count > max_pixel_fragments)
            throw Unsupported(fmt::format("the pixel has {} fragments; the limit is {}", count, max_pixel_fragments));
        if (count > first_capacity) {
            words.resize(std::size_t{count} * words_per_fragment);
            count = draw(program, words, timer);
        }
        std::vector<PixelFragment> fragments(count);
        for (std::size_t i = 0; i < count; ++i) fragments[i] = read_fragment(&words[i * words_per_fragment]);
        const auto key = [](const PixelFragment& f) { return std::tuple(f.depth, ~f.primitive); };
        std::ranges::sort(fragments, {}, key);
        return fragments;
    }

    /// Fills `words` and says how many fragments there are, which may be more than fit.
    std::uint32_t draw(const gl::Program& program, std::vector<std::uint32_t>& words, gl::FrameTimer& timer) const {
        const auto pass = timer.pass("autopsy", gl::Phase::transparent);
        const auto bytes = static_cast<GLsizeiptr>(words.size() * sizeof(words[0]));
        std::uint32_t count = 0;
        const gl::Buffer fragments = gl::make_buffer(m_gl, "autopsy: fragments", bytes, nullptr);
        const gl::Buffer counter = gl::make_buffer(m_gl, "autopsy: count", sizeof(count), &count);
        begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
        m_gl.Enable(GL_SCISSOR_TEST);
        m_gl.Scissor(m_x, m_y, 1, 1);
        set_transparent_depth_state(m_gl);
        m_gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, fragments.id());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counter.id());
        m_scene.draw_transparent(program, Order::submission);
        m_gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        m_gl.GetNamedBufferSubData(counter.id(), 0, sizeof(count), &count);
        m_gl.GetNamedBufferSubData(fragments.id(), 0, bytes, words.data());
        return count;
    }

    static PixelFragment read_fragment(const std::uint32_t* words) {
        const auto number = [&](std::size_t i) { return double{std::bit_cast<float>(words[i])}; };
        return {
            .depth = number(4), .color = {number(0), number(1), number(2)}, .alpha = number(3), .primitive = words[5]};
    }

    gl::Context& m_context;
    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    int m_x, m_y;
};

}  // namespace

void weigh(PixelStack& stack) {
    stack.transmittance = 1;
    stack.sum = {};
    const auto add = [&stack](const Rgb& color, double weight) {
        for (std::size_t i = 0; i < 3; ++i) stack.sum[i] += weight * color[i];
    };
    for (PixelFragment& fragment : stack.fragments) {
        fragment.transmittance_before = stack.transmittance;
        fragment.weight = stack.transmittance * fragment.alpha;
        add(fragment.color, fragment.weight);
        stack.transmittance *= 1 - fragment.alpha;
    }
    add(stack.opaque ? stack.opaque->color : stack.background, stack.transmittance);
}

PixelStack take_pixel_apart(const Spec& spec, gl::Context& context, AssetReader& assets, int x, int y) {
    const Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    const Scene scene(context.gl(), geometry, spec.scene);
    check_loops(context.gl(), scene, spec.image);
    const Target target(context.gl(), spec.image, PixelFormat::rgba32f);
    PixelStack stack = Autopsy(context, scene, target, x, y).run();
    weigh(stack);
    return stack;
}

}  // namespace sheer
