#include "renderer/counting/shading_counter.h"

#include <algorithm>
#include <array>
#include <regex>
#include <string_view>

#include <fmt/format.h>

namespace sheer {

namespace {

/// Drawing primitives separately costs two draws and their state for each.
constexpr std::size_t most_single_draws = 100000;

/// Comes after a method's source, whose main() count_shaded.glsl renames where it counts warps.
constexpr const char* own_main = "\n#undef main\nvoid main() { counted_main(); }\n";

/// The program as its author wrote it: without comments and without the lines that only count.
std::string without_counting(const gl::Program& program) {
    std::string source = program.fragment_source();
    const std::string counting = gl::shader_file("scenes/count_shaded.glsl");
    if (const std::size_t at = source.find(counting); at != std::string::npos) source.erase(at, counting.size());
    static const std::regex comment("//[^\n]*");
    return std::regex_replace(source, comment, "");
}

bool contains_any(const std::string& source, std::initializer_list<const char*> words) {
    return std::ranges::any_of(words, [&](const char* word) { return source.find(word) != std::string::npos; });
}

/// It writes depth, or memory that others may read: the shader must have run before its fragment can be tested.
bool must_run_first(const gl::Functions& gl, const gl::Program& program, const std::string& source) {
    return gl.GetProgramResourceIndex(program.id(), GL_PROGRAM_OUTPUT, "gl_FragDepth") != GL_INVALID_INDEX ||
           contains_any(source, {"imageStore", "imageAtomic", "atomicAdd", "atomicExchange"});
}

bool query_runs(const gl::Functions& gl) {
    for (const GLenum target : {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE}) {
        GLint query = 0;
        gl.GetQueryiv(target, GL_CURRENT_QUERY, &query);
        if (query != 0) return true;
    }
    return false;
}

/// Adds the properties of the current state.
DrawKind with_state(DrawKind kind, const gl::Functions& gl) {
    GLboolean depth_mask = GL_FALSE;
    GLint stencil_mask = 0;
    gl.GetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask);
    gl.GetIntegerv(GL_STENCIL_WRITEMASK, &stencil_mask);
    kind.tests_depth = gl.IsEnabled(GL_DEPTH_TEST) == GL_TRUE;
    kind.writes_depth = kind.tests_depth && depth_mask == GL_TRUE;
    kind.tests_stencil = gl.IsEnabled(GL_STENCIL_TEST) == GL_TRUE;
    if (kind.tests_stencil) {
        kind.has_stencil_mask = (stencil_mask & 0xff) != 0;
        gl.GetIntegerv(GL_STENCIL_FAIL, &kind.stencil_fails);
        gl.GetIntegerv(GL_STENCIL_PASS_DEPTH_FAIL, &kind.depth_fails);
        gl.GetIntegerv(GL_STENCIL_PASS_DEPTH_PASS, &kind.depth_passes);
    }
    gl.GetIntegerv(GL_SAMPLES, &kind.samples);
    kind.samples = std::max(kind.samples, 1);
    kind.covers_by_alpha = kind.samples > 1 && gl.IsEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE) == GL_TRUE;
    return kind;
}

/// Whether a fragment that passes early tests may still not be written.
bool may_be_cut(const DrawKind& kind) {
    return kind.discards || kind.writes_sample_mask || kind.covers_by_alpha;
}

/// Turns off all writes while it exists.
class NothingWritten {
  public:
    explicit NothingWritten(const gl::Functions& gl) : m_gl(gl) {
        gl.GetBooleanv(GL_DEPTH_WRITEMASK, &m_depth);
        gl.GetBooleani_v(GL_COLOR_WRITEMASK, 0, m_color.data());
        gl.GetIntegerv(GL_STENCIL_WRITEMASK, &m_stencil);
        gl.DepthMask(GL_FALSE);
        gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        gl.StencilMask(0);
    }
    ~NothingWritten() {
        m_gl.DepthMask(m_depth);
        m_gl.ColorMask(m_color[0], m_color[1], m_color[2], m_color[3]);
        m_gl.StencilMask(static_cast<GLuint>(m_stencil));
    }
    NothingWritten(const NothingWritten&) = delete;
    NothingWritten& operator=(const NothingWritten&) = delete;

  private:
    const gl::Functions& m_gl;
    GLboolean m_depth = GL_TRUE;
    std::array<GLboolean, 4> m_color{};
    GLint m_stencil = 0;
};

/// Pixels of the counter per pixel of the current viewport.
glm::vec2 scale_to(const gl::Functions& gl, const CountImage& image) {
    std::array<GLint, 4> viewport{};
    gl.GetIntegerv(GL_VIEWPORT, viewport.data());
    return {static_cast<float>(image.width_px()) / static_cast<float>(viewport[2]),
            static_cast<float>(image.height_px()) / static_cast<float>(viewport[3])};
}

/// Adds up the parts of a count, each of another kind of draw.
class Sum {
  public:
    explicit Sum(PixelCounts zero) : m_counts(std::move(zero)) {}
    void add(const PixelCounts& part) {
        for (std::size_t i = 0; i < m_counts.counts.size(); ++i) m_counts.counts[i] += part.counts[i];
    }
    void fail(const std::string& reason) { m_reason = reason; }
    void put_into(std::optional<PixelCounts>& counts, std::string& reason) {
        if (m_reason.empty()) counts = std::move(m_counts);
        reason = m_reason;
    }

  private:
    PixelCounts m_counts;
    std::string m_reason;
};

}  // namespace

ShadingCounter::ShadingCounter(const gl::Functions& gl, Scene& scene, const Target& target)
    : m_gl(gl),
      m_scene(scene),
      m_width_px(target.width_px()),
      m_height_px(target.height_px()),
      m_warps(gl, scene, m_width_px, m_height_px),
      m_counted(gl, "shaded before", m_width_px, m_height_px) {
    m_scene.observe(this);
}

ShadingCounter::~ShadingCounter() {
    m_scene.observe(nullptr);
}

const ShadingCounter::Variants& ShadingCounter::variants_of(const gl::Program& program) {
    const auto known = m_variants.find(program.id());
    if (known != m_variants.end()) return known->second;
    const std::string source = without_counting(program);
    Variants variants;
    variants.specified = contains_any(source, {"early_fragment_tests"}) ? Specified::early
                         : must_run_first(m_gl, program, source)        ? Specified::late
                                                                        : Specified::nowhere;
    variants.shader.discards = contains_any(source, {"discard"});
    variants.shader.writes_sample_mask = contains_any(source, {"gl_SampleMask["});
    variants.shader.fetches_framebuffer = contains_any(source, {"shader_framebuffer_fetch"});
    const std::string rest = program.fragment_source().substr(std::string_view(glsl_version).size());
    variants.late = program.with_fragment_source("shaded fragments",
                                                 glsl_version + std::string("#define SHEER_COUNT_SHADED\n") + rest);
    const std::string layout = variants.specified == Specified::nowhere ? "layout(early_fragment_tests) in;" : "";
    variants.early = program.with_fragment_source(
        "shaded fragments and warps",
        glsl_version + ("#define SHEER_COUNT_WARPS\n#define SHEER_COUNT_SHADED " + layout + "\n") + rest + own_main);
    return m_variants.emplace(program.id(), std::move(variants)).first->second;
}

ShadingCounter::Tally& ShadingCounter::tally_of(const Key& key) {
    const auto known = m_tallies.find(key);
    if (known != m_tallies.end()) return known->second;
    const auto image = [this] { return CountImage(m_gl, "shaded fragments", m_width_px, m_height_px); };
    return m_tallies.emplace(key, Tally{image(), image(), ""}).first->second;
}

void ShadingCounter::test_early(std::size_t window) {
    m_early = true;
    m_window = window;
    m_warps.choose_window(window);
}

void ShadingCounter::prepare(const gl::Program& original, const gl::Program& variant, const CountImage& image) const {
    variant.copy_uniforms(original);
    variant.set("u_shaded_scale", scale_to(m_gl, image));
    image.bind();
}

void ShadingCounter::prepare_early(const gl::Program& original, const gl::Program& variant,
                                   const CountImage& image) const {
    prepare(original, variant, m_window == 0 ? image : m_counted);
    m_warps.count_in(variant);
}

void ShadingCounter::draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) {
    m_early ? draw_early(program, order, first, count) : draw_late(program, order, first, count);
}

/// Its fragments meet no test but the shader's own.
void ShadingCounter::gather(const gl::Program& program) {
    const Variants& variants = variants_of(program);
    Tally& tally = tally_of({Specified::nowhere, DrawKind()});
    m_early ? prepare_early(program, variants.early, tally.early) : prepare(program, variants.late, tally.late);
    m_scene.gather_unobserved(m_early ? variants.early : variants.late);
}

void ShadingCounter::draw_late(const gl::Program& program, Order order, std::size_t first, std::size_t count) {
    const Variants& variants = variants_of(program);
    prepare(program, variants.late, tally_of({variants.specified, with_state(variants.shader, m_gl)}).late);
    m_scene.draw_unobserved(variants.late, order, first, count);
}

void ShadingCounter::draw_early(const gl::Program& program, Order order, std::size_t first, std::size_t count) {
    const Variants& variants = variants_of(program);
    const DrawKind kind = with_state(variants.shader, m_gl);
    Tally& tally = tally_of({variants.specified, kind});
    m_warps.begin_draw(order, first, count);
    if (variants.specified == Specified::late)
        tally.no_early_reason = "the shader writes depth or memory, so its fragments are not tested before it has run";
    if (variants.specified != Specified::nowhere) {
        prepare_early(program, variants.early, m_counted);
        return m_scene.draw_unobserved(variants.early, order, first, count);
    }
    const bool cuts_late = may_be_cut(kind), draws_twice = cuts_late && (kind.writes_depth || kind.writes_stencil());
    if (cuts_late && query_runs(m_gl))
        tally.no_early_reason = "the method asks how many samples pass, which counting would disturb";
    else if (draws_twice && count > most_single_draws)
        tally.no_early_reason = fmt::format("counting would draw each of {} primitives separately; the limit is {}",
                                            count, most_single_draws);
    if (!tally.no_early_reason.empty()) {
        m_no_warps_reason = tally.no_early_reason;
        return m_scene.draw_unobserved(program, order, first, count);
    }
    prepare_early(program, variants.early, tally.early);
    if (draws_twice) {
        draw_twice(program, variants.early, order, first, count);
    } else {
        m_scene.draw_unobserved(variants.early, order, first, count);
    }
}

void ShadingCounter::draw_twice(const gl::Program& program, const gl::Program& variant, Order order, std::size_t first,
                                std::size_t count) const {
    for (std::size_t i = first; i < first + count; ++i) {
        {
            const NothingWritten nothing(m_gl);
            m_scene.draw_unobserved(variant, order, i, 1);
        }
        m_scene.draw_unobserved(program, order, i, 1);
    }
}

ShadingCount ShadingCounter::read(EarlyTests& early_tests) {
    const PixelCounts none{m_width_px, m_height_px,
                           std::vector<std::uint32_t>(static_cast<std::size_t>(m_width_px) * m_height_px)};
    Sum shaded(none), visible(none);
    ShadingCount result;
    bool specified = false, probed = false;
    for (const auto& [key, tally] : m_tallies) {
        const PixelCounts late = tally.late.read();
        const PixelCounts early = key.first == Specified::early ? late : tally.early.read();
        const bool knows_early = tally.no_early_reason.empty();
        knows_early ? visible.add(early) : visible.fail(tally.no_early_reason);
        if (key.first != Specified::nowhere) specified = true;
        if (key.first != Specified::nowhere || !key.second.tests() || (knows_early && early.counts == late.counts)) {
            shaded.add(late);
            continue;
        }
        probed = true;
        const TestTime time = early_tests.ask(key.second);
        if (time == TestTime::late) {
            shaded.add(late);
        } else if (time == TestTime::early && knows_early) {
            shaded.add(early);
        } else if (time == TestTime::early) {
            shaded.fail(tally.no_early_reason);
        } else {
            shaded.fail(
                fmt::format("it is unclear whether this device tests fragments before it shades them: it shades {} "
                            "if so, {} if not",
                            knows_early ? std::to_string(early.total()) : "an unknown number", late.total()));
        }
    }
    shaded.put_into(result.shaded, result.no_shaded_reason);
    visible.put_into(result.visible, result.no_visible_reason);
    result.no_warps_reason = m_no_warps_reason.empty() ? m_warps.reason() : m_no_warps_reason;
    if (result.no_warps_reason.empty()) result.warps = m_warps.read();
    if (result.shaded) result.shaded_by = probed ? "probed" : specified ? "specified" : "no_test_fails";
    return result;
}

ShadingCount count_shaded(const gl::Functions& gl, Scene& scene, const Target& target, EarlyTests& early_tests,
                          const std::function<void()>& render_frame) {
    ShadingCounter counter(gl, scene, target);
    render_frame();
    for (std::size_t window = 0; window < counter.windows(); ++window) {
        counter.test_early(window);
        render_frame();
    }
    return counter.read(early_tests);
}

}  // namespace sheer
