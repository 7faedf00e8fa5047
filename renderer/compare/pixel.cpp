#include "renderer/compare/pixel.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <tuple>

#include "renderer/compare/looks.h"
#include "renderer/methods/shared/method.h"
#include "renderer/passes/pass.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

constexpr std::uint32_t words_per_fragment = 6;  // as in shaders/common/pixel.glsl
constexpr std::uint32_t first_capacity = 1024;   // fragments for which no counting pass is needed

class FragmentReader {
  public:
    FragmentReader(gl::Context& context, const Scene& scene, const Target& target, int x, int y)
        : m_context(context), m_gl(context.gl()), m_scene(scene), m_target(target), m_x(x), m_y(y) {}

    PixelStack run() {
        gl::FrameTimer timer(m_context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        OpaquePass(m_gl, m_scene, m_target).draw(timer);
        PixelStack stack;
        for (int i = 0; i < 3; ++i) stack.background[i] = m_target.background()[i];
        stack.opaque = read_opaque();
        stack.fragments = collect(timer);
        frame.end();
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
        const gl::Program program = m_scene.make_program("pixel", gl::shader_file("common/pixel.glsl"));
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

    /// Fills `words` and returns the number of fragments, which may be more than fit.
    std::uint32_t draw(const gl::Program& program, std::vector<std::uint32_t>& words, gl::FrameTimer& timer) const {
        const auto pass = timer.pass("pixel", gl::Phase::transparent);
        const auto bytes = static_cast<GLsizeiptr>(words.size() * sizeof(words[0]));
        std::uint32_t count = 0;
        const gl::Buffer fragments = gl::make_buffer(m_gl, "pixel: fragments", bytes, nullptr);
        const gl::Buffer counter = gl::make_buffer(m_gl, "pixel: count", sizeof(count), &count);
        Pass drawing(m_gl, m_target);
        drawing.scissor(m_x, m_y, 1, 1);
        drawing.transparent_depth();
        drawing.no_color();
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

/// Draws one pixel of each method's frame, and lets the methods explain it.
class Explainer {
  public:
    Explainer(const Spec& spec, gl::Context& context, Scene& scene, const PixelStack& stack, int x, int y)
        : m_context(context),
          m_scene(scene),
          m_target(context.gl(), spec.image, spec.image.format),
          m_timer(context),
          m_x(x),
          m_y(y) {
        for (const PixelFragment& fragment : stack.fragments)
            m_fragments.push_back({fragment.primitive, fragment.depth, fragment.alpha});
        if (stack.opaque) m_opaque_depth = stack.opaque->depth;
    }

    Explanation explain(const MethodSpec& spec) {
        if (m_fragments.size() > max_explained_fragments)
            return {.reason = fmt::format("the pixel has {} fragments; the limit is {}", m_fragments.size(),
                                          max_explained_fragments)};
        try {
            Explanation explanation = draw_and_explain(spec);
            m_context.check("explaining " + spec.label);
            return explanation;
        } catch (const Unsupported& unsupported) {
            return {.reason = unsupported.what()};
        }
    }

  private:
    Explanation draw_and_explain(const MethodSpec& spec) {
        const gl::Functions& gl = m_context.gl();
        const auto method = find_method(spec.id)->make({m_context, gl, m_scene, m_target}, spec.parameters);
        if (method->keeps_frames()) render(*method);
        const PixelTrace trace(gl, m_scene, {m_target.width_px(), m_target.height_px()}, {m_x, m_y}, m_fragments,
                               m_opaque_depth);
        render(*method);
        Explanation explanation;
        const glm::vec4 value = read_texel(gl, m_target.color(), m_x, m_y);
        explanation.value = Rgb{value.r, value.g, value.b};
        explanation.facts = method->explain(trace);
        return explanation;
    }

    void render(Method& method) {
        gl::FrameTimer::Frame frame = m_timer.frame(false);
        method.render(m_timer);
        frame.end();
    }

    gl::Context& m_context;
    Scene& m_scene;
    const Target m_target;
    gl::FrameTimer m_timer;
    int m_x, m_y;
    std::vector<PixelTrace::Surface> m_fragments;  ///< near to far
    double m_opaque_depth = 1;
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

PixelStack explain_pixel(const Spec& spec, gl::Context& context, AssetReader& assets, int x, int y) {
    const Geometry geometry = build_geometry_of_looks(spec, assets);
    Looks looks(spec, context.gl(), geometry);
    const Target target(context.gl(), spec.image, PixelFormat::rgba32f);
    const auto stack_in = [&](const Scene& scene) { return FragmentReader(context, scene, target, x, y).run(); };
    PixelStack stack = stack_in(looks.own_scene());
    weigh(stack);
    for (const MethodSpec& method : spec.methods) {
        Scene& scene = *looks.of(method).scene;
        const bool is_own = &scene == &looks.own_scene();
        stack.methods.push_back(
            Explainer(spec, context, scene, is_own ? stack : stack_in(scene), x, y).explain(method));
    }
    return stack;
}

}  // namespace sheer
