// F2BG: front-to-back blending turned round. Instead of every triangle visiting its pixels, every pixel walks the
// triangles of its tile from near to far, keeps its color and transmittance in registers, and stops when it is
// saturated: the test before shading that SCCG 2010 asks for in section 4, without a blending unit. A compute pass sets
// one bit per triangle and tile, so the bits have the order of the triangles and nothing is sorted on the device. Edge
// functions (Pineda, A Parallel Algorithm for Polygon Rasterization, SIGGRAPH 1988), depth and level of detail are
// evaluated by the shader. Batches of triangles grow; a tile without an open pixel takes part in no later batch.
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/float_opaque.h"

namespace sheer {

namespace {

struct F2bgParameters {
    double threshold = 0.01;
    std::size_t first_batch = 1024;
    double growth = 4;
    std::size_t tile_px = 8;

    static ParamTable<F2bgParameters> table() {
        return ParamTable<F2bgParameters>()
            .number(&F2bgParameters::threshold, "threshold",
                    "a pixel is done when less than this transmittance is left; 0 stops none", "", 0, 1)
            .integer(&F2bgParameters::first_batch, "first_batch", "primitives of the first batch", "", 1, 1000000)
            .number(&F2bgParameters::growth, "growth", "primitives of a batch by those of the batch before", "", 1, 16)
            .integer(&F2bgParameters::tile_px, "tile_px", "width and height of a tile", "px", 4, 256);
    }
};

struct TileGrid {
    int tile_px, columns, rows;
    TileGrid(const Target& target, int size_px)
        : tile_px(size_px), columns(up(target.width_px(), size_px)), rows(up(target.height_px(), size_px)) {}
    int count() const { return columns * rows; }
    static int up(int whole, int part) { return (whole + part - 1) / part; }
};

/// Triangles that are binned and walked together, in the order near to far.
struct Batch {
    std::size_t first = 0, count = 0;
};

constexpr std::size_t triangle_texels = 15;         // of 16 bytes: shaders/methods/f2bg_triangle.glsl
constexpr std::size_t most_mask_bytes = 64u << 20;  // of all tiles
// llvmpipe silently leaves all loops of a shader after 65,535 iterations; some are those of the walk itself.
constexpr std::size_t most_iterations = 60000;

std::size_t most_texels(const gl::Functions& gl) {
    GLint most = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    return static_cast<std::size_t>(most);
}

std::size_t most_mask_words(const gl::Functions& gl) {
    return std::min(most_texels(gl), most_mask_bytes / sizeof(std::uint32_t));
}

/// How many triangles of a batch may touch each tile.
class TileCounts {
  public:
    explicit TileCounts(const TileGrid& grid)
        : m_columns(grid.columns), m_rows(grid.rows), m_counts(static_cast<std::size_t>(grid.count())) {}

    /// For a rectangle in fractions of the image.
    std::size_t most_in(const glm::vec4& rect) {
        std::size_t most = 0;
        visit(rect, [&most](std::size_t& count) { most = std::max(most, count); });
        return most;
    }
    void add(const glm::vec4& rect, std::size_t triangles) {
        visit(rect, [triangles](std::size_t& count) { count += triangles; });
    }
    void clear() { std::ranges::fill(m_counts, 0); }

  private:
    void visit(const glm::vec4& rect, const auto& action) {
        // Rounding may put a fragment outside of the rectangle.
        const auto tile = [](float fraction, int by, int size) {
            return std::clamp(static_cast<int>(std::floor(fraction * static_cast<float>(size))) + by, 0, size - 1);
        };
        for (int row = tile(rect[1], -1, m_rows); row <= tile(rect[3], 1, m_rows); ++row)
            for (int column = tile(rect[0], -1, m_columns); column <= tile(rect[2], 1, m_columns); ++column)
                action(m_counts[static_cast<std::size_t>(row * m_columns + column)]);
    }

    int m_columns, m_rows;
    std::vector<std::size_t> m_counts;
};

/// Divides the triangles into batches, which grow but stay within the memory of the masks, and in which no pixel can
/// reach the limit of iterations.
std::vector<Batch> make_batches(const gl::Functions& gl, const Scene& scene, const TileGrid& grid,
                                const F2bgParameters& parameters) {
    const std::size_t per_triangle = 2 + static_cast<std::size_t>(scene.most_iterations());
    const std::size_t most_in_a_tile = std::max<std::size_t>(most_iterations / per_triangle, 1);
    const std::size_t mask_words = most_mask_words(gl) / static_cast<std::size_t>(grid.count());
    // A 32nd of the words say which of the others have bits.
    const std::size_t most_triangles =
        std::max<std::size_t>(std::min(mask_words * 31, most_texels(gl) / triangle_texels), 1);
    TileCounts counts(grid);
    std::vector<Batch> batches(1);
    std::size_t primitives = 0;
    auto size = static_cast<double>(parameters.first_batch);
    const auto end_batch = [&] {
        if (static_cast<double>(primitives) >= size) size *= parameters.growth;
        batches.push_back({batches.back().first + batches.back().count, 0});
        primitives = 0;
        counts.clear();
    };
    for (std::size_t place = 0; place < scene.transparent_count(); ++place) {
        if (static_cast<double>(primitives) >= size) end_batch();
        const glm::vec4& rect = scene.screen_rects()[scene.primitive_at(Order::near_to_far, place)];
        for (std::size_t left = scene.triangle_count(Order::near_to_far, place, 1); left > 0;) {
            const std::size_t part = std::min({left, most_in_a_tile, most_triangles});
            if (batches.back().count + part > most_triangles || counts.most_in(rect) + part > most_in_a_tile)
                end_batch();
            counts.add(rect, part);
            batches.back().count += part;
            left -= part;
        }
        ++primitives;
    }
    return batches;
}

class Gathering : public Method {
  public:
    Gathering(const MethodSetup& setup, const F2bgParameters& parameters)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_grid(setup.target, static_cast<int>(parameters.tile_px)),
          m_batches(make_batches(setup.gl, setup.scene, m_grid, parameters)),
          m_most_triangles(most_triangles(m_batches)),
          m_words(TileGrid::up(m_most_triangles, 32)),
          m_coarse_words(TileGrid::up(m_words, 32)),
          m_accumulation(setup.gl, setup.target, PixelFormat::rgba32f),
          m_picture(gl::make_framebuffer(setup.gl, "f2bg: picture", std::array{m_accumulation.color().id()}, 0)),
          m_triangles(make_buffer("f2bg: triangles",
                                  static_cast<std::size_t>(m_most_triangles) * triangle_texels * sizeof(glm::vec4))),
          m_masks(make_buffer("f2bg: masks", sizeof(std::uint32_t) * static_cast<std::size_t>(m_grid.count()) *
                                                 static_cast<std::size_t>(m_words + m_coarse_words))),
          m_open(
              make_buffer("f2bg: open tiles", sizeof(std::uint32_t) * (static_cast<std::size_t>(m_grid.count()) + 1))),
          m_triangle_texels(make_view("f2bg: triangles", GL_RGBA32F, m_triangles)),
          m_mask_texels(make_view("f2bg: masks", GL_R32UI, m_masks)),
          m_bin(gl::Program::compute(setup.gl, "f2bg: bin",
                                     glsl_version + prolog() + gl::shader_file("methods/f2bg_triangle.glsl") +
                                         gl::shader_file("methods/f2bg_bin.comp.glsl"))),
          m_walk(setup.scene.make_gathering_program(
              "f2bg", gl::shader_file("methods/f2bg_triangle.glsl") + gl::shader_file("methods/f2bg.glsl"), prolog())) {
        for (const gl::Program* program : {&m_bin, &m_walk}) {
            program->set("u_columns", m_grid.columns);
            program->set("u_rows", m_grid.rows);
        }
        m_bin.set("u_size_px", glm::vec2(setup.target.width_px(), setup.target.height_px()));
        m_walk.set("u_threshold", static_cast<float>(parameters.threshold));
    }

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_accumulation.clear(1);
            fill(m_open, 1);
        }
        for (const Batch& batch : m_batches) {
            {
                const auto pass = timer.pass("bin", gl::Phase::transparent);
                bin(batch);
            }
            const auto pass = timer.pass("walk", gl::Phase::transparent);
            walk();
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_opaque.composite(m_accumulation.color());
    }

    /// {"batches"}: how many.
    nlohmann::json findings(gl::FrameTimer&) override { return {{"batches", m_batches.size()}}; }

    std::int64_t memory_bytes() const override {
        return gl::memory_bytes_of(m_opaque, m_accumulation, m_triangles, m_masks, m_open);
    }

  private:
    static int most_triangles(const std::vector<Batch>& batches) {
        return std::max(static_cast<int>(std::ranges::max_element(batches, {}, &Batch::count)->count), 1);
    }

    std::string prolog() const {
        const auto define = [](const char* name, int value) {
            return std::string("#define ") + name + " " + std::to_string(value) + "\n";
        };
        return define("TILE_PX", m_grid.tile_px) + define("WORDS", m_words) + define("COARSE_WORDS", m_coarse_words) +
               define("VERTEX_WORDS", sizeof(Vertex) / sizeof(std::uint32_t)) +
               define("SHEER_EMISSION_UVS", m_scene.has_emission_uvs());
    }

    gl::Buffer make_buffer(std::string_view label, std::size_t bytes) const {
        return gl::make_buffer(m_gl, label, static_cast<GLsizeiptr>(bytes), nullptr);
    }

    gl::Texture make_view(std::string_view label, GLenum format, const gl::Buffer& buffer) const {
        GLuint id = 0;
        m_gl.CreateTextures(GL_TEXTURE_BUFFER, 1, &id);
        gl::Texture texture(m_gl, id, label);
        m_gl.TextureBuffer(id, format, buffer.id());
        return texture;
    }

    void fill(const gl::Buffer& buffer, std::uint32_t value) const {
        m_gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        m_gl.ClearNamedBufferData(buffer.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    }

    void bin(const Batch& batch) const {
        fill(m_masks, 0);
        m_scene.bind_triangles(m_bin, Order::near_to_far);
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, m_triangles.id());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, m_masks.id());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, m_open.id());
        m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        m_bin.set("u_first", static_cast<unsigned>(batch.first));
        m_bin.set("u_count", static_cast<unsigned>(batch.count));
        m_bin.use();
        m_gl.DispatchCompute(static_cast<GLuint>((batch.count + 63) / 64), 1, 1);
    }

    void walk() const {
        fill(m_open, 0);
        m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
        const Pass walking(m_gl, m_picture, m_target.width_px(), m_target.height_px());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, m_open.id());
        m_walk.set_texture("u_triangles", m_triangle_texels);
        m_walk.set_texture("u_masks", m_mask_texels);
        m_walk.set_texture("u_accumulation", m_accumulation.color());
        m_walk.set_texture("u_depth", m_target.depth());
        // Every pixel reads itself before it is written.
        m_gl.TextureBarrier();
        m_scene.gather(m_walk);
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    FloatOpaque m_opaque;
    TileGrid m_grid;
    std::vector<Batch> m_batches;
    int m_most_triangles, m_words, m_coarse_words;
    Accumulation m_accumulation;
    gl::Framebuffer m_picture;
    gl::Buffer m_triangles, m_masks, m_open;
    gl::Texture m_triangle_texels, m_mask_texels;  ///< views of the buffers
    gl::Program m_bin, m_walk;
};

}  // namespace

MethodInfo method_f2bg() {
    return describe_method(
        {
            .id = "f2bg",
            .name = "F2BG",
            .kind = "sorted blending with early discard",
            .summary =
                "F2B by gathering: every pixel walks the triangles of its tile from near to far, in registers, and "
                "stops when it is saturated.",
            .paper = "Sheer, after section 4 of Vlcek, Havel, Herout, SCCG 2010",
            .good_at =
                "Heavy overdraw: no fragment beyond saturation is shaded or starts a shader, and the sum is kept "
                "in 32-bit floats and rounded once.",
            .bad_at = "Few layers, where the hardware's rasterizer is quicker; large triangles in many tiles; GLSL "
                      "that takes derivatives.",
            .memory = "32 bytes per pixel; 240 bytes per triangle and a bit per triangle and tile, of a batch",
            .passes = "a full-screen one for each batch of triangles, and one more",
            .needs = "compute shaders, storage buffers, texture buffers",
            .saturation_parameter = "threshold",
        },
        F2bgParameters::table(), make_new<Gathering>, bytes_by_scene);
}

}  // namespace sheer
