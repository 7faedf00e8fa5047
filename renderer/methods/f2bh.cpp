// F2BH: what SCCG 2010 asks for in section 4, a test that stops a fragment before its shader starts, with today's
// OpenGL. Front-to-back blending in batches that grow. After each batch, as with depth marks (Krueger and Westermann,
// VIS 2003), pixels with less than `threshold` of the transmittance left are written to the nearest depth, where the
// early depth test rejects all later fragments. Then each tile without an open pixel is closed: it is never marked
// again, and primitives whose tiles are all closed are dropped by their vertex stage before anything is rasterised.
// What is saturated within a batch is discarded as in F2BD, so that few marks suffice. Batches are measured by the area
// of their primitives, as only layers upon layers can saturate pixels: a scene with few of them is drawn without any
// mark. Nothing is read back, so the device never waits for the host.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"

namespace sheer {

namespace {

struct F2bhParameters {
    enum class Within { nothing, discards };

    double threshold = 0.01;
    Within within = Within::discards;
    double first_layers = 6;
    double growth = 1.25;
    std::size_t tile_px = 16;

    static ParamTable<F2bhParameters> table() {
        return ParamTable<F2bhParameters>()
            .number(&F2bhParameters::threshold, "threshold",
                    "a pixel is closed when less than this transmittance is left; 0 closes none", "", 0, 1)
            .choice(&F2bhParameters::within, "within_batch",
                    "what stops a fragment whose pixel was saturated within its batch: nothing, or it reads the "
                    "transmittance like f2bd and is discarded",
                    {{"nothing", Within::nothing}, {"discard", Within::discards}})
            .number(&F2bhParameters::first_layers, "first_layers",
                    "layers before the first mark: the primitives' rectangles on the screen, over the picture's area",
                    "", 0, 1000000)
            .number(&F2bhParameters::growth, "growth", "layers of a batch by those of the batch before", "", 1, 16)
            .integer(&F2bhParameters::tile_px, "tile_px",
                     "width and height of a tile; images of more than 256 tiles a side have larger ones", "px", 4, 256);
    }
};

/// Which tiles of the image still have an open pixel.
class OpenTiles {
  public:
    static constexpr int most_a_side = 256, rects_a_row = 4096;

    OpenTiles(const MethodSetup& setup, int tile_px, float threshold)
        : m_gl(setup.gl),
          m_tile_px(std::max(
              {tile_px, tiles(setup.target.width_px(), most_a_side), tiles(setup.target.height_px(), most_a_side)})),
          m_columns(tiles(setup.target.width_px(), m_tile_px)),
          m_rows(tiles(setup.target.height_px(), m_tile_px)),
          m_tile_rects(make_tile_rects(setup)),
          m_closed_before(make_grid("f2bh: closed pixels of tiles")),
          m_row_sums(make_grid("f2bh: open tiles of rows")),
          m_sums(make_grid("f2bh: open tiles")),
          m_scan(setup.gl, "f2bh: scan", gl::shader_file("methods/f2bh_scan.glsl"), prolog()),
          m_sum_rows(setup.gl, "f2bh: sum rows", gl::shader_file("methods/f2bh_sum.glsl"),
                     prolog() + "#define SHEER_SUM_ROWS 1\n"),
          m_sum_columns(setup.gl, "f2bh: sum columns", gl::shader_file("methods/f2bh_sum.glsl"),
                        prolog() + "#define SHEER_SUM_ROWS 0\n"),
          m_scanned(make_framebuffer("f2bh: scan", m_closed_before)),
          m_summed_rows(make_framebuffer("f2bh: sum rows", m_row_sums)),
          m_summed(make_framebuffer("f2bh: sum columns", m_sums)) {
        m_scan.program().set("u_threshold", threshold);
    }

    int count() const { return m_columns * m_rows; }
    /// The number of tiles in the image's width and height, in fractions too.
    glm::vec2 size(const Target& target) const {
        return glm::vec2(target.width_px(), target.height_px()) / static_cast<float>(m_tile_px);
    }
    unsigned pixels_of_a_tile() const { return static_cast<unsigned>(m_tile_px * m_tile_px); }
    const gl::Texture& closed_before() const { return m_closed_before; }

    /// Opens all.
    void reset() {
        if (!m_scans_since_reset) return;
        m_scans_since_reset = false;
        {
            const Pass clearing(m_gl, m_scanned, m_columns, m_rows);
            clearing.clear_color(glm::uvec4(0), 0);
        }
        sum();
    }
    /// Closes those in which this accumulation has no open pixel any more.
    void scan(const Accumulation& accumulation) {
        m_scans_since_reset = true;
        {
            const Pass scanning(m_gl, m_scanned, m_columns, m_rows);
            m_scan.program().set_texture("u_accumulation", accumulation.readable_alpha());
            m_scan.program().set_texture("u_closed_before", m_closed_before);
            m_gl.TextureBarrier();
            m_scan.draw();
        }
        sum();
    }
    /// For a program with methods/f2bh_skip.vert.glsl.
    void set_textures(const gl::Program& program) const {
        program.set_texture("u_tile_rects", m_tile_rects);
        program.set_texture("u_open_tiles", m_sums);
    }
    std::int64_t memory_bytes() const { return gl::memory_bytes_of(m_tile_rects, m_closed_before, m_row_sums, m_sums); }

  private:
    static int tiles(int image_px, int tile_px) { return (image_px + tile_px - 1) / tile_px; }
    std::string prolog() const { return "#define TILE_PX " + std::to_string(m_tile_px) + "\n"; }
    gl::Texture make_grid(std::string_view label) const {
        return gl::make_texture_2d(m_gl, label, GL_R32UI, m_columns, m_rows);
    }
    gl::Framebuffer make_framebuffer(std::string_view label, const gl::Texture& grid) const {
        return gl::make_framebuffer(m_gl, label, std::array{grid.id()}, 0);
    }

    gl::Texture make_tile_rects(const MethodSetup& setup) const {
        const std::vector<glm::vec4>& rects = setup.scene.screen_rects();
        const int rows = std::max(1, tiles(static_cast<int>(rects.size()), rects_a_row));
        std::vector<std::uint32_t> packed(static_cast<std::size_t>(rows) * rects_a_row);
        const glm::vec2 tiles_of_image = size(setup.target);
        // Rounding may put a fragment that much outside of a primitive's rectangle.
        constexpr float slack = 1.0f / 256;
        const auto column = [&](float fraction, float by) {
            return static_cast<std::uint32_t>(
                std::clamp(std::floor(fraction * tiles_of_image.x + by), 0.0f, static_cast<float>(m_columns - 1)));
        };
        const auto row = [&](float fraction, float by) {
            return static_cast<std::uint32_t>(
                std::clamp(std::floor(fraction * tiles_of_image.y + by), 0.0f, static_cast<float>(m_rows - 1)));
        };
        std::ranges::transform(rects, packed.begin(), [&](const glm::vec4& rect) {
            return column(rect[0], -slack) | row(rect[1], -slack) << 8 | column(rect[2], slack) << 16 |
                   row(rect[3], slack) << 24;
        });
        gl::Texture texture = gl::make_texture_2d(m_gl, "f2bh: tiles of primitives", GL_R32UI, rects_a_row, rows);
        m_gl.TextureSubImage2D(texture.id(), 0, 0, 0, rects_a_row, rows, GL_RED_INTEGER, GL_UNSIGNED_INT,
                               packed.data());
        return texture;
    }

    void sum() const {
        sum(m_sum_rows, m_closed_before, m_summed_rows);
        sum(m_sum_columns, m_row_sums, m_summed);
    }
    void sum(const FullscreenPass& sums, const gl::Texture& from, const gl::Framebuffer& to) const {
        const Pass summing(m_gl, to, m_columns, m_rows);
        sums.program().set_texture("u_summed", from);
        sums.draw();
    }

    const gl::Functions& m_gl;
    int m_tile_px, m_columns, m_rows;
    gl::Texture m_tile_rects, m_closed_before, m_row_sums, m_sums;
    FullscreenPass m_scan, m_sum_rows, m_sum_columns;
    gl::Framebuffer m_scanned, m_summed_rows, m_summed;
    bool m_scans_since_reset = true;
};

/// The numbers of primitives in the batches, from near to far. Each batch has at least one.
std::vector<std::size_t> divide_into_batches(const Scene& scene, const F2bhParameters& parameters) {
    constexpr double rounding = 1e-4;
    std::vector<std::size_t> batches;
    double wanted = parameters.first_layers, layers = 0;
    std::size_t primitives = 0;
    for (std::size_t place = 0; place < scene.transparent_count(); ++place) {
        const glm::vec4 rect =
            glm::clamp(scene.screen_rects()[scene.primitive_at(Order::near_to_far, place)], 0.0f, 1.0f);
        layers += double{rect.z - rect.x} * double{rect.w - rect.y};
        ++primitives;
        if (layers < wanted * (1 - rounding)) continue;
        batches.push_back(primitives);
        wanted *= parameters.growth;
        layers = 0;
        primitives = 0;
    }
    if (primitives > 0) batches.push_back(primitives);
    return batches;
}

class ClosingTiles : public OpaqueFirst {
  public:
    ClosingTiles(const MethodSetup& setup, const F2bhParameters& parameters)
        : OpaqueFirst(setup),
          m_parameters(parameters),
          m_counts_early(parameters.within == F2bhParameters::Within::discards && !setup.context.device().software),
          m_accumulation(setup.gl, setup.target, setup.target.format()),
          m_batches(divide_into_batches(setup.scene, parameters)),
          m_tiles(setup, static_cast<int>(parameters.tile_px), static_cast<float>(parameters.threshold)),
          m_program(make_program(setup, parameters)),
          m_mark(setup.gl, "f2bh: mark", gl::shader_file("methods/f2bh_mark.vert.glsl"),
                 glsl_version + gl::shader_file("common/saturated.glsl")),
          m_no_attributes(gl::make_vertex_array(setup.gl, "f2bh: mark")),
          m_depth_only(
              gl::make_framebuffer(setup.gl, "f2bh: mark", std::span<const GLuint>(), setup.target.depth().id())) {
        m_program.set("u_threshold", static_cast<float>(parameters.threshold));
        m_mark.set("u_threshold", static_cast<float>(parameters.threshold));
        m_mark.set("u_tiles", m_tiles.size(setup.target));
        m_mark.set("u_all_closed", m_tiles.pixels_of_a_tile());
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_tiles.reset();
            m_accumulation.clear(1);
        }
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            draw_batches();
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_accumulation.composite();
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const PixelTrace::Draws draws = trace.of(m_program);
        std::vector<std::size_t> blended = draws.passed(), rejected = draws.failed();
        if (m_counts_early) reject_saturated(trace, blended, rejected);
        std::vector<PixelFact> facts = {
            fragments_fact(
                "blended", blended,
                "The fragments that were blended, including those between saturation and the mark if nothing "
                "stops them within a batch."),
            fragments_fact(
                "rejected", rejected,
                "The fragments whose pixel was closed, by a mark or within their own batch; those of dropped "
                "primitives never were.")};
        add_accumulated(facts, draws.color);
        return facts;
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_accumulation, m_tiles); }

  private:
    static gl::Program make_program(const MethodSetup& setup, const F2bhParameters& parameters) {
        const bool discards = parameters.within == F2bhParameters::Within::discards;
        return setup.scene.make_skipping_program("f2bh",
                                                 gl::shader_file(discards ? "methods/f2bd.glsl" : "methods/f2b.glsl"),
                                                 gl::shader_file("methods/f2bh_skip.vert.glsl"),
                                                 "layout(early_fragment_tests) in;\n"
                                                 "#define SHEER_FRAMEBUFFER_FETCH 0\n"
                                                 "#define SHEER_SEPARATE_ALPHA 0\n"
                                                 "#define SHEER_IF_ELSE 1\n"
                                                 "#define SHEER_INVERTED 1\n");
    }

    /// Moves to `rejected` what the device counted as passed before its shader discarded it.
    void reject_saturated(const PixelTrace& trace, std::vector<std::size_t>& blended,
                          std::vector<std::size_t>& rejected) const {
        double transmittance = 1;
        const auto first = std::ranges::find_if(blended, [&](std::size_t number) {
            if (transmittance < m_parameters.threshold) return true;
            transmittance *= 1 - trace.alpha(number);
            return false;
        });
        rejected.insert(rejected.begin(), first, blended.end());
        blended.erase(first, blended.end());
    }

    void draw_batches() {
        std::size_t first = 0;
        for (const std::size_t batch : m_batches) {
            {
                const Pass drawing = m_accumulation.blending();
                m_tiles.set_textures(m_program);
                if (m_parameters.within == F2bhParameters::Within::discards) {
                    m_program.set_texture("u_alpha", m_accumulation.readable_alpha());
                    m_gl.TextureBarrier();
                }
                m_scene.draw_transparent(m_program, Order::near_to_far, first, batch);
            }
            first += batch;
            if (first == m_scene.transparent_count()) break;
            mark();
            m_tiles.scan(m_accumulation);
        }
    }

    /// The marks go into the target's own depth, which after the opaque pass is needed only by the depth test.
    void mark() const {
        Pass marking = begin(m_depth_only);
        marking.depth_test(GL_LESS);
        m_mark.set_texture("u_accumulation", m_accumulation.readable_alpha());
        m_mark.set_texture("u_closed_before", m_tiles.closed_before());
        m_mark.use();
        m_gl.BindVertexArray(m_no_attributes.id());
        m_gl.DrawArrays(GL_TRIANGLES, 0, 6 * m_tiles.count());
    }

    F2bhParameters m_parameters;
    bool m_counts_early;  ///< whether an occlusion query counts fragments that an early-tested shader then discards
    Accumulation m_accumulation;
    std::vector<std::size_t> m_batches;
    OpenTiles m_tiles;
    gl::Program m_program, m_mark;
    gl::VertexArray m_no_attributes;
    gl::Framebuffer m_depth_only;
};

}  // namespace

MethodInfo method_f2bh() {
    return describe_method(
        {
            .id = "f2bh",
            .name = "F2BH",
            .kind = "sorted blending with early discard",
            .summary =
                "F2B in growing batches; saturated pixels are closed to the depth test, and primitives that only "
                "meet closed tiles are dropped before rasterisation.",
            .paper = "Sheer, after section 4 of Vlcek, Havel, Herout, SCCG 2010, and depth marks",
            .good_at = "Heavy overdraw: it shades little more than the fragments that are needed, starts shaders for "
                       "few others, and reads nothing back.",
            .bad_at = "Scenes that never saturate pay for the marks; few layers or cheap shading; feedback needs a "
                      "barrier per batch.",
            .memory = "one pixel of the image format, 12 bytes per tile and 4 per primitive",
            .passes = "1, and a full-screen one; a mark over the tiles after each batch",
            .needs = "texture barriers",
            .saturation_parameter = "threshold",
        },
        F2bhParameters::table(), make_new<ClosingTiles>, bytes_by_scene);
}

}  // namespace sheer
