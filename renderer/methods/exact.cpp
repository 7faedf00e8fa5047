// The reference: every fragment of a pixel is kept, sorted by depth and composited with the opaque picture in 32-bit
// floats. It is rounded only once, to the target's format.
// Lists: per-pixel linked lists with atomics (Yang, Hensley, Gruen, Thibieroz, Real-Time Concurrent Linked List
// Construction on the GPU, EGSR 2010). The fragments are counted first, and the image is cut into tiles whose fragments
// fit the memory, so that none is ever dropped. In the first frame the number of fragments drawn is compared with the
// number counted: if a driver draws more, the method fails rather than lose one. Each list is sorted by merging runs,
// in several passes, because a shader's loops may have an iteration limit (65,535 on llvmpipe).
// Sorted: if the primitives are parallel, drawing them from near to far into 32-bit floats gives the same picture
// faster; form `auto` then uses it.
#include <algorithm>
#include <array>

#include "renderer/methods/shared/method.h"
#include "renderer/passes/accumulation.h"
#include "renderer/passes/float_opaque.h"
#include "renderer/passes/overdraw.h"

namespace sheer {

namespace {

constexpr std::int64_t node_bytes = 28;      // color 16, depth 4, primitive 4, next 4
constexpr std::int64_t loop_budget = 40000;  // iterations in one pass, under llvmpipe's 65,535

struct ExactParameters {
    enum class Form { automatic, lists, sorted };

    Form form = Form::automatic;
    std::int64_t memory_mib = 256;

    static ParamTable<ExactParameters> table() {
        return ParamTable<ExactParameters>()
            .choice(&ExactParameters::form, "form",
                    "per-pixel lists, or sorted blending into 32-bit floats, which is as exact if "
                    "primitives are parallel; auto uses sorted if possible",
                    {{"auto", Form::automatic}, {"lists", Form::lists}, {"sorted", Form::sorted}})
            .integer(&ExactParameters::memory_mib, "memory_mib",
                     "memory for the lists; the image is cut into tiles that fit", "MiB", 1, 4096);
    }
};

struct ScreenTile {
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

/// Halves `tile` until the fragments of each part fit.
void divide(const PixelCounts& overdraw, ScreenTile tile, std::uint64_t capacity, std::vector<ScreenTile>& tiles) {
    const std::uint64_t fragments = overdraw.total_in(tile.x0, tile.y0, tile.x1, tile.y1);
    if (fragments == 0) return;
    if (fragments <= capacity) {
        tiles.push_back(tile);
        return;
    }
    if (tile.width() == 1 && tile.height() == 1)
        throw Unsupported("one pixel has " + std::to_string(fragments) + " fragments; the lists hold " +
                          std::to_string(capacity));
    const bool wide = tile.width() >= tile.height();
    const int middle = wide ? tile.x0 + tile.width() / 2 : tile.y0 + tile.height() / 2;
    divide(overdraw,
           wide ? ScreenTile{tile.x0, tile.y0, middle, tile.y1} : ScreenTile{tile.x0, tile.y0, tile.x1, middle},
           capacity, tiles);
    divide(overdraw,
           wide ? ScreenTile{middle, tile.y0, tile.x1, tile.y1} : ScreenTile{tile.x0, middle, tile.x1, tile.y1},
           capacity, tiles);
}

class LinkedLists : public Method {
  public:
    LinkedLists(const MethodSetup& setup, const ExactParameters& parameters)
        : m_gl(setup.gl),
          m_scene(setup.scene),
          m_target(setup.target),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_build(setup.scene.make_program("exact: build", source("build"))),
          m_sort(setup.gl, "exact: sort", source("sort")),
          m_composite(setup.gl, "exact: composite", source("composite")) {
        std::int64_t largest_block = 0;
        m_gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest_block);
        const std::int64_t wanted = parameters.memory_mib << 20;
        m_capacity = static_cast<std::uint64_t>(std::min(largest_block, wanted) / node_bytes);
    }

    void render(gl::FrameTimer& timer) override {
        const bool first = !m_nodes;
        if (first) prepare(timer);
        m_opaque.draw(timer);
        m_opaque.copy_to_target();
        for (const ScreenTile& tile : m_tiles) {
            build(tile, timer);
            if (first) require_all_kept(tile);
            sort_and_composite(tile, timer);
        }
    }

    /// {"lists": {"fragments", "kept", "tiles", "memory_bytes"}}: how many were counted, and how many the lists held.
    nlohmann::json findings(gl::FrameTimer&) override {
        return {{"lists",
                 {{"fragments", m_overdraw.total()},
                  {"kept", m_kept},
                  {"tiles", m_tiles.size()},
                  {"memory_bytes", gl::memory_bytes_of(m_nodes, m_heads)}}}};
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_nodes, m_heads, m_opaque); }

  private:
    static std::string source(const std::string& stage) {
        return std::string(gl::shader_file("methods/exact_lists.glsl")) +
               std::string(gl::shader_file("methods/exact_" + stage + ".glsl"));
    }

    /// The scene does not change from frame to frame, so it is counted once.
    void prepare(gl::FrameTimer& timer) {
        m_overdraw = count_overdraw(m_gl, m_scene, m_target, timer);
        m_longest = m_overdraw.greatest();
        if (m_longest > loop_budget)
            throw Unsupported("one pixel has " + std::to_string(m_longest) + " fragments; a pass can sort " +
                              std::to_string(loop_budget));
        divide(m_overdraw, {0, 0, m_target.width_px(), m_target.height_px()}, m_capacity, m_tiles);
        std::uint64_t most_nodes = 1, most_pixels = 1;
        for (const ScreenTile& tile : m_tiles) {
            most_nodes = std::max(most_nodes, counted_in(tile));
            most_pixels = std::max(most_pixels, static_cast<std::uint64_t>(tile.width()) * tile.height());
        }
        const auto nodes_bytes = static_cast<GLsizeiptr>(most_nodes * node_bytes);
        const auto heads_bytes = static_cast<GLsizeiptr>((most_pixels + 1) * sizeof(std::uint32_t));
        m_nodes = gl::make_buffer(m_gl, "exact: nodes", nodes_bytes, nullptr);
        m_heads = gl::make_buffer(m_gl, "exact: heads", heads_bytes, nullptr);
    }

    std::uint64_t counted_in(const ScreenTile& tile) const {
        return m_overdraw.total_in(tile.x0, tile.y0, tile.x1, tile.y1);
    }

    /// Every fragment takes a number, even one that finds no room.
    void require_all_kept(const ScreenTile& tile) {
        std::uint32_t drawn = 0;
        m_gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        m_gl.GetNamedBufferSubData(m_heads.id(), 0, sizeof drawn, &drawn);
        if (drawn > counted_in(tile))
            throw RenderError("exact: the driver drew " + std::to_string(drawn) + " fragments but had counted " +
                              std::to_string(counted_in(tile)) + "; some would be lost");
        m_kept += drawn;
    }

    [[nodiscard]] Pass begin_tile(const ScreenTile& tile) const {
        Pass drawing(m_gl, m_target);
        drawing.scissor(tile.x0, tile.y0, tile.width(), tile.height());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, m_nodes.id());
        m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, m_heads.id());
        m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        return drawing;
    }

    static void set_tile(const gl::Program& program, const ScreenTile& tile) {
        program.set("u_tile_x", tile.x0);
        program.set("u_tile_y", tile.y0);
        program.set("u_tile_width", tile.width());
    }

    void build(const ScreenTile& tile, gl::FrameTimer& timer) const {
        const auto pass = timer.pass("build", gl::Phase::transparent);
        Pass drawing = begin_tile(tile);
        const std::uint32_t zero = 0;
        m_gl.ClearNamedBufferData(m_heads.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
        drawing.transparent_depth();
        drawing.no_color();
        set_tile(m_build, tile);
        m_scene.draw_transparent(m_build, Order::submission);
    }

    void sort_and_composite(const ScreenTile& tile, gl::FrameTimer& timer) const {
        const auto pass = timer.pass("resolve", gl::Phase::finalization);
        set_tile(m_sort.program(), tile);
        // One merge of all runs traverses a list about one and a half times.
        const auto merges_per_pass =
            static_cast<int>(std::clamp<std::int64_t>(loop_budget / (2 * std::max(m_longest, 1u)), 1, 32));
        for (std::uint64_t run = 1; run < m_longest; run <<= merges_per_pass) {
            Pass drawing = begin_tile(tile);
            drawing.no_color();
            m_sort.program().set("u_run", static_cast<unsigned>(run));
            m_sort.program().set("u_merges", merges_per_pass);
            m_sort.draw();
        }
        const Pass drawing = begin_tile(tile);
        m_composite.program().set_texture("u_opaque", m_opaque.color());
        set_tile(m_composite.program(), tile);
        m_composite.draw();
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    FloatOpaque m_opaque;
    gl::Program m_build;
    FullscreenPass m_sort, m_composite;
    std::uint64_t m_capacity = 0;
    PixelCounts m_overdraw;
    std::uint64_t m_kept = 0;
    std::uint32_t m_longest = 0;
    std::vector<ScreenTile> m_tiles;
    gl::Buffer m_nodes, m_heads;
};

bool draws_sorted(const Scene& scene, const ExactParameters& parameters) {
    return scene.parallel() && parameters.form != ExactParameters::Form::lists;
}

class SortedInFloats : public Method {
  public:
    explicit SortedInFloats(const MethodSetup& setup)
        : m_scene(setup.scene),
          m_opaque(setup.gl, setup.scene, setup.target),
          m_accumulation(setup.gl, setup.target, PixelFormat::rgba32f),
          m_program(setup.scene.make_program("exact: sorted", gl::shader_file("methods/f2b.glsl"))) {}

    void render(gl::FrameTimer& timer) override {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            m_accumulation.clear(1);
        }
        {
            const auto pass = timer.pass("transparent", gl::Phase::transparent);
            const Pass drawing = m_accumulation.blending();
            m_scene.draw_transparent(m_program, Order::near_to_far);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        m_opaque.composite(m_accumulation.color());
    }

    std::int64_t memory_bytes() const override { return gl::memory_bytes_of(m_opaque, m_accumulation); }

  private:
    const Scene& m_scene;
    FloatOpaque m_opaque;
    Accumulation m_accumulation;
    gl::Program m_program;
};

std::unique_ptr<Method> make_exact(const MethodSetup& setup, const ExactParameters& parameters) {
    if (parameters.form == ExactParameters::Form::sorted && !setup.scene.parallel())
        throw Unsupported("form sorted needs parallel primitives, but those of this scene may intersect");
    if (!draws_sorted(setup.scene, parameters)) return std::make_unique<LinkedLists>(setup, parameters);
    return std::make_unique<SortedInFloats>(setup);
}

}  // namespace

MethodInfo method_exact() {
    return describe_method(
        {
            .id = "exact",
            .name = "Exact",
            .kind = "reference",
            .summary = "Every fragment of a pixel, sorted by depth and composited in 32-bit floats; rounded once.",
            .paper =
                "Yang, Hensley, Gruen, Thibieroz, Real-Time Concurrent Linked List Construction on the GPU, EGSR 2010",
            .good_at = "The correct picture for any geometry, including intersecting primitives.",
            .bad_at = "Memory and time grow with every fragment.",
            .memory = "16 bytes per pixel and 28 bytes per fragment of a tile; 32 bytes per pixel in the sorted form",
            .passes =
                "2 and 2 full-screen ones for each tile of the picture; 1 and a full-screen one in the sorted form",
            .needs = "storage buffers and atomics in fragment shaders",
            .needs_sorting = false,
        },
        ExactParameters::table(), make_exact,
        [](const ExactParameters& parameters, int) -> std::optional<double> {
            return parameters.form == ExactParameters::Form::sorted ? std::optional(32.0) : std::nullopt;
        },
        draws_sorted);
}

}  // namespace sheer
