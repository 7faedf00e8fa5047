// Opaque fragments that close their pixel: "D3D: Drawing Transparency Front to Back", Correcting The Future
// (exploreopera blog, 2008). F2B's equations; fully transparent fragments are dropped, and a pixel that an opaque
// source fragment has covered is marked, so that nothing is blended there again. Opacity that only accumulates does not
// mark. `variant` says how it is marked:
//   shader_depth  The fragment writes depth: 0 if translucent; if opaque, a value that decreases by one step with every
//                 triangle, so that under GREATER_EQUAL a later opaque fragment fails like a translucent one. When a
//                 batch has used up the steps, the marks are merged into the stencil and the depth is cleared.
//   target_alpha  As shader_depth, but between batches every pixel whose transmittance is used up gets the greatest
//                 depth, read from the target itself: no stencil, and accumulated opacity marks as well. `mark_pass`
//                 alpha_test clears the depth and draws where the test passes; shader writes it everywhere and clears
//                 nothing.
//   two_pass      Every primitive is drawn twice: first only its opaque fragments, which set the stencil; then its
//                 translucent ones.
// `marks` static is the article's first attempt, one value for all opaque fragments: its fourth case, opaque behind
// opaque, is blended again (invisibly, since no transmittance is left); the findings count it.
// OpenGL has no 16-bit depth with a stencil: with `depth_bits` 16 shader_depth uses 65,535 steps of a 24-bit buffer.
// With 32 a step is the next smaller float, of which there are over 10^9 from 1 down to 0. Since the shader writes
// depth, it still runs for all fragments, except in two_pass, which draws every primitive separately, twice, and
// ignores the other parameters.
#include <algorithm>
#include <limits>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/own_depth.h"

namespace sheer {

namespace {

struct OpaqueDepthParameters {
    enum class Variant { shader_depth, target_alpha, two_pass };
    enum class Marks { incremental, fixed };
    enum class MarkPass { alpha_test, shader };

    Variant variant = Variant::shader_depth;
    Marks marks = Marks::incremental;
    int depth_bits = 24;
    std::size_t batch = 0;
    MarkPass mark_pass = MarkPass::alpha_test;

    static ParamTable<OpaqueDepthParameters> table() {
        return ParamTable<OpaqueDepthParameters>()
            .choice(&OpaqueDepthParameters::variant, "variant",
                    "how a pixel is marked: by the depth that the shader writes, merged into the stencil; also by the "
                    "target's alpha between batches; or by two passes per primitive",
                    {{"shader_depth", Variant::shader_depth},
                     {"target_alpha", Variant::target_alpha},
                     {"two_pass", Variant::two_pass}})
            .choice(
                &OpaqueDepthParameters::marks, "marks",
                "incremental: the opaque fragments of each triangle get a smaller depth; static: one depth for all, "
                "so that opaque behind opaque is blended again (counted in the findings)",
                {{"incremental", Marks::incremental}, {"static", Marks::fixed}})
            .integer(&OpaqueDepthParameters::depth_bits, "depth_bits",
                     "16, 24 or 32: 2^15, 2^23 or, in floats, about 2^30 triangles can be distinguished before a merge",
                     "bits", 16, 32)
            .in_steps_of(8)
            .integer(&OpaqueDepthParameters::batch, "batch",
                     "primitives between merges; 0: as many as the depth has steps for", "", 0, 1000000)
            .choice(&OpaqueDepthParameters::mark_pass, "mark_pass",
                    "for target_alpha: an alpha test after a clear, or a shader that writes the depth of every pixel",
                    {{"alpha_test", MarkPass::alpha_test}, {"shader", MarkPass::shader}});
    }
};

using Variant = OpaqueDepthParameters::Variant;

GLenum depth_format(Variant variant, int depth_bits) {
    switch (variant) {
        case Variant::shader_depth:
            return depth_bits == 32 ? GL_DEPTH32F_STENCIL8 : GL_DEPTH24_STENCIL8;
        case Variant::target_alpha:
            return depth_bits == 16   ? GL_DEPTH_COMPONENT16
                   : depth_bits == 24 ? GL_DEPTH_COMPONENT24
                                      : GL_DEPTH_COMPONENT32F;
        case Variant::two_pass:
            return GL_DEPTH32F_STENCIL8;
    }
    throw std::logic_error("unknown variant");
}

/// OpenGL has no 16-bit depth with a stencil, and pads 24 bits without one.
int depth_bytes(const OpaqueDepthParameters& parameters) {
    switch (depth_format(parameters.variant, parameters.depth_bits)) {
        case GL_DEPTH_COMPONENT16:
            return 2;
        case GL_DEPTH32F_STENCIL8:
            return 8;
        default:
            return 4;
    }
}

/// Steps of depth between 0 and 1: as many floats as there are, or a power of two that the fixed-point
/// format can distinguish: a GPU may round any other quotient to its neighbour.
constexpr int float_steps = 0x3f800000;  // 1.0f in bits
int steps_of(int depth_bits) {
    return depth_bits == 32 ? float_steps : 1 << (depth_bits - 1);
}

/// Less than half of the format's resolution near 1; float formats resolve more, which is not worth a layer.
float half_step(PixelFormat format) {
    return format == PixelFormat::rgba8 ? 0.5f / 255 : 1e-6f;
}

/// First primitive of each batch, and one past the last: each has at most `batch` (if not 0) primitives and `steps`
/// triangles, but at least one primitive.
std::vector<std::size_t> make_batches(const Scene& scene, std::size_t batch, std::size_t steps) {
    std::vector<std::size_t> bounds = {0};
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < scene.transparent_count(); ++i) {
        const std::size_t more = scene.triangle_count(Order::near_to_far, i, 1);
        const bool full = (batch != 0 && i - bounds.back() == batch) || triangles + more > steps;
        if (full && i > bounds.back()) {
            bounds.push_back(i);
            triangles = 0;
        }
        triangles += more;
    }
    bounds.push_back(scene.transparent_count());
    return bounds;
}

class OpaqueDepth : public OpaqueFirst {
  public:
    OpaqueDepth(const MethodSetup& setup, const OpaqueDepthParameters& parameters)
        : OpaqueFirst(setup),
          m_variant(parameters.variant),
          m_static(parameters.marks == OpaqueDepthParameters::Marks::fixed),
          m_shader_marks(parameters.mark_pass == OpaqueDepthParameters::MarkPass::shader),
          m_steps(steps_of(parameters.depth_bits)),
          m_batches(make_batches(
              setup.scene, parameters.batch,
              m_static ? std::numeric_limits<std::size_t>::max() : static_cast<std::size_t>(m_steps - first_step()))),
          m_accumulation(setup.gl, setup.target, setup.target.format()),
          m_depth(setup.gl, setup.target, m_accumulation.readable_alpha().id(),
                  depth_format(m_variant, parameters.depth_bits)),
          m_merge(setup.gl, "opaque depth: merge", gl::shader_file("methods/opaque_depth_merge.glsl")),
          m_saturated(setup.gl, "opaque depth: saturated",
                      gl::shader_file(m_shader_marks ? "methods/opaque_depth_mark.glsl" : "common/saturated.glsl")) {
        m_saturated.program().set("u_threshold", half_step(setup.target.format()));
        if (m_variant == Variant::two_pass) {
            m_program = make_program(setup, "#define SHEER_OPAQUE_ONLY\n");
            m_translucent = make_program(setup, "#define SHEER_TRANSLUCENT_ONLY\nlayout(early_fragment_tests) in;\n");
        } else {
            m_program = make_program(setup, "#define SHEER_SHADER_DEPTH\n");
            m_program.set("u_first", first_step());
            m_program.set("u_step", m_static ? 0 : 1);
            m_program.set("u_steps", m_steps == float_steps ? 0 : m_steps);
        }
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_accumulation.clear(1);
            if (m_variant == Variant::two_pass) {
                m_depth.copy_opaque();
            } else {
                m_depth.clear(0);
            }
        }
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            if (m_variant == Variant::two_pass) {
                draw_twice();
            } else {
                draw_batches();
            }
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_accumulation.composite();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const PixelTrace::Draws draws = trace.of(m_program);
        const std::optional<std::size_t> closing = closed_by(draws, m_depth.read(trace.x(), trace.y()));
        std::vector<std::size_t> blended = draws.passed();
        std::optional<glm::vec4> color = draws.color;
        if (m_variant == Variant::two_pass) {
            const PixelTrace::Draws translucent = trace.of(m_translucent);
            blended = translucent.passed();
            if (closing) std::erase_if(blended, [&](std::size_t number) { return number >= *closing; });
            // With early tests a device may count a fragment that its shader then discards.
            std::erase_if(blended,
                          [&](std::size_t number) { return trace.alpha(number) < half_step(m_target.format()); });
            if (closing) blended.push_back(*closing);
            color = translucent.color;
        }
        std::vector<std::size_t> transparent, behind;
        for (const PixelTrace::Fragment& fragment : draws.fragments) {
            if (std::ranges::count(blended, fragment.number) > 0) continue;
            (blended.empty() || fragment.number < blended.back() ? transparent : behind).push_back(fragment.number);
        }
        std::vector<PixelFact> facts = {
            fragment_fact(
                "closed_by", closing,
                "The fragment after which the pixel was marked: an opaque one, or with target_alpha the last "
                "of a batch that used up the transmittance; with static marks the last opaque one; none if it was "
                "not marked."),
            fragments_fact("blended", blended, "The fragments that were blended, near to far."),
            fragments_fact("dropped", transparent, "The fully transparent fragments between them."),
            fragments_fact("behind", behind,
                           "The fragments after the last one that was blended: behind a mark, or fully "
                           "transparent.")};
        add_accumulated(facts, color);
        return facts;
    }

    /// {"blended_again": n} for static marks: opaque fragments of a frame that were blended behind another opaque one
    /// of their batch. Counted as the number of samples that pass in addition to those that pass with incremental
    /// marks.
    nlohmann::json findings(gl::FrameTimer& timer) override {
        if (!m_static || m_variant == Variant::two_pass) return nlohmann::json::object();
        const std::int64_t with_static = samples_of_frame(timer);
        m_program.set("u_step", 1);
        const std::int64_t with_incremental = samples_of_frame(timer);
        m_program.set("u_step", 0);
        return {{"blended_again", with_static - with_incremental}};
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_accumulation, m_depth); }

  private:
    static gl::Program make_program(const MethodSetup& setup, const std::string& prolog) {
        gl::Program program =
            setup.scene.make_program("opaque depth", gl::shader_file("methods/opaque_depth.glsl"), prolog);
        program.set("u_half_step", half_step(setup.target.format()));
        return program;
    }

    /// The greatest mark of target_alpha belongs to pixels that earlier batches closed.
    int first_step() const { return m_variant == Variant::target_alpha ? 1 : 0; }

    std::int64_t samples_of_frame(gl::FrameTimer& timer) {
        const gl::Query query = gl::make_query(m_gl, "opaque depth: samples", GL_SAMPLES_PASSED);
        m_gl.BeginQuery(GL_SAMPLES_PASSED, query.id());
        render(timer);
        m_gl.EndQuery(GL_SAMPLES_PASSED);
        GLuint samples = 0;
        m_gl.GetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &samples);
        return samples;
    }

    /// With two passes, the fragment that the opaque pass let through. Otherwise the last fragment that was drawn, if
    /// there is a mark: after a mark none is drawn.
    std::optional<std::size_t> closed_by(const PixelTrace::Draws& draws, const OwnDepth::Texel& left) const {
        const bool is_marked = m_variant == Variant::two_pass || left.stencil != 0 || left.depth > 0;
        return is_marked ? draws.last_passed() : std::nullopt;
    }

    void draw_batches() const {
        for (std::size_t i = 0; i + 1 < m_batches.size(); ++i) {
            if (i > 0) m_variant == Variant::shader_depth ? merge_into_stencil() : mark_saturated();
            Pass drawing = m_depth.blending();
            drawing.depth_test(GL_GEQUAL);
            test_stencil(drawing, GL_KEEP, GL_KEEP);
            m_program.set_texture("u_opaque_depth", m_target.depth());
            m_program.set("u_batch_triangle",
                          static_cast<int>(m_scene.triangle_count(Order::near_to_far, 0, m_batches[i])));
            m_scene.draw_transparent(m_program, Order::near_to_far, m_batches[i], m_batches[i + 1] - m_batches[i]);
        }
    }

    /// Where the depth is not 0 the test fails, which inverts the 0 in the stencil.
    void merge_into_stencil() const {
        {
            Pass merging = m_depth.depth_only();
            merging.depth_test(GL_EQUAL);
            merging.depth_write(false);
            test_stencil(merging, GL_INVERT, GL_KEEP);
            m_merge.draw();
        }
        m_depth.depth_only().clear_depth(0);
    }

    void mark_saturated() const {
        if (!m_shader_marks) m_depth.clear(0);
        Pass marking = m_depth.depth_only();
        if (!m_shader_marks) marking.depth_range(1, 1);
        marking.depth_test(GL_ALWAYS);
        m_saturated.program().set_texture("u_accumulation", m_accumulation.readable_alpha());
        m_saturated.draw();
    }

    void draw_twice() const {
        Pass drawing = m_depth.blending();
        drawing.transparent_depth();
        for (std::size_t i = 0; i < m_scene.transparent_count(); ++i) {
            test_stencil(drawing, GL_KEEP, GL_INVERT);
            m_scene.draw_transparent(m_program, Order::near_to_far, i, 1);
            test_stencil(drawing, GL_KEEP, GL_KEEP);
            m_scene.draw_transparent(m_translucent, Order::near_to_far, i, 1);
        }
    }

    /// Draws only pixels that are not marked; without a stencil buffer, all pixels.
    static void test_stencil(Pass& pass, GLenum depth_fails, GLenum passes) {
        pass.stencil(GL_EQUAL, 0, GL_KEEP, depth_fails, passes);
    }

    Variant m_variant;
    bool m_static, m_shader_marks;
    int m_steps;
    std::vector<std::size_t> m_batches;
    Accumulation m_accumulation;
    OwnDepth m_depth;
    FullscreenPass m_merge, m_saturated;
    gl::Program m_program, m_translucent;
};

}  // namespace

MethodInfo method_opaque_depth() {
    return describe_method(
        {
            .id = "opaque_depth",
            .name = "Opaque depth",
            .kind = "sorted blending with early discard",
            .summary =
                "F2B in which a pixel is closed by the first fully opaque fragment; transparent ones are dropped.",
            .paper = "D3D: Drawing Transparency Front to Back, Correcting The Future, 2008",
            .good_at =
                "Textures with opaque cores: behind an opaque texel nothing is blended or written; F2B's picture.",
            .bad_at =
                "Opacity that builds up from translucent layers closes no pixel (except in target_alpha); no shading "
                "is saved if the shader writes depth.",
            .memory = "one pixel of the image format and 2 to 8 bytes of depth and stencil",
            .passes = "1, or 2 in two_pass, and a full-screen one; another after each batch",
            .needs = "a depth that the shader writes, stencil",
        },
        OpaqueDepthParameters::table(), make_new<OpaqueDepth>,
        [](const OpaqueDepthParameters& parameters, int pixel_bytes) -> std::optional<double> {
            return pixel_bytes + depth_bytes(parameters);
        });
}

}  // namespace sheer
