// Multi-layer alpha blending: Salvi and Vaidyanathan, Multi-Layer Alpha Blending, I3D 2014. Each pixel keeps a few
// nodes sorted by depth, each a premultiplied color and a transmittance. A fragment is inserted in its place; the last
// two of then one too many are merged by the over operator. That is exact as long as nothing comes between what was
// merged, so with more fragments than nodes the picture depends on the order of submission. A fragment reads and writes
// all nodes of its pixel, so fragments of a pixel must not run at the same time: framebuffer fetch orders them as
// submitted.
#include <algorithm>
#include <cmath>

#include "renderer/methods/shared/blended_sums.h"
#include "renderer/passes/texel.h"

namespace sheer {

namespace {

constexpr const char* mlab_extension = "GL_EXT_shader_framebuffer_fetch";
constexpr int depths_per_texture = 4;

struct MlabParameters {
    int nodes = 4;

    static ParamTable<MlabParameters> table() {
        return ParamTable<MlabParameters>().integer(
            &MlabParameters::nodes, "nodes",
            "nodes per pixel; as many targets, and one or two for their depths, are all that a device must have", "", 2,
            6);
    }
};

int depth_textures(const MlabParameters& parameters) {
    return (parameters.nodes + depths_per_texture - 1) / depths_per_texture;
}

class Mlab : public OpaqueFirst {
  public:
    Mlab(const MethodSetup& setup, const MlabParameters& parameters)
        : OpaqueFirst(setup),
          m_node_count(static_cast<std::size_t>(parameters.nodes)),
          m_insert(make_insert(setup, parameters)),
          m_composite(setup.gl, "mlab: composite", gl::shader_file("methods/mlab_composite.glsl"), prolog(parameters)) {
        std::vector<GLuint> colors;
        for (int i = 0; i < parameters.nodes + depth_textures(parameters); ++i) {
            const bool is_node = i < parameters.nodes;
            m_textures.push_back(
                m_target.make_texture(is_node ? "mlab: node" : "mlab: depths",
                                      is_node ? four_channel_sums(m_target) : static_cast<GLenum>(GL_RGBA32F)));
            colors.push_back(m_textures.back().id());
        }
        m_framebuffer = gl::make_framebuffer(m_gl, "mlab", colors, m_target.depth().id());
    }

    void render(gl::FrameTimer& timer) override { render(timer, Order::submission); }

    /// {"order": {"greatest_change"}}: how much a color changes at most, 0 to 1, if the primitives are submitted from
    /// near to far.
    nlohmann::json findings(gl::FrameTimer& timer) override {
        const Image sorted = frame_in(Order::near_to_far, timer), submitted = frame_in(Order::submission, timer);
        double greatest = 0;
        for (std::size_t i = 0; i < sorted.rgba.size(); ++i)
            greatest = std::max(greatest, std::abs(double{sorted.rgba[i]} - submitted.rgba[i]));
        return {{"order", {{"greatest_change", greatest}}}};
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        double transmittance = 1;
        glm::vec3 color(0);
        for (std::size_t i = 0; i < m_node_count; ++i) {
            const glm::vec4 node = read_texel(m_gl, m_textures[i], trace.x(), trace.y());
            color += static_cast<float>(transmittance) * glm::vec3(node);
            transmittance *= node.a;
        }
        return {color_fact("nodes_color", color, "The color of all nodes, blended from near to far."),
                number_fact("opaque_weight", transmittance, "What they let through of the opaque color.")};
    }

    std::int64_t memory_bytes() const override {
        std::int64_t bytes = 0;
        for (const gl::Texture& texture : m_textures) bytes += texture.memory_bytes();
        return bytes;
    }

  private:
    static std::string prolog(const MlabParameters& parameters) {
        return "#define SHEER_NODES " + std::to_string(parameters.nodes) + "\n";
    }

    static gl::Program make_insert(const MethodSetup& setup, const MlabParameters& parameters) {
        if (!setup.context.has_extension(mlab_extension))
            throw Unsupported(std::string("the nodes of a pixel need ") + mlab_extension);
        return setup.scene.make_program(
            "mlab: insert", gl::shader_file("methods/mlab_insert.glsl"),
            std::string("#extension ") + mlab_extension + " : require\n" + prolog(parameters));
    }

    void render(gl::FrameTimer& timer, Order order) const {
        m_opaque.draw(timer);
        {
            const auto pass = timer.pass("clear", gl::Phase::initialization);
            const Pass clearing = begin(m_framebuffer);
            for (std::size_t i = 0; i < m_textures.size(); ++i)
                clearing.clear_color(i < m_node_count ? glm::vec4(0, 0, 0, 1) : glm::vec4(2), static_cast<int>(i));
        }
        {
            const auto pass = timer.pass("insert", gl::Phase::transparent);
            Pass drawing = begin(m_framebuffer);
            drawing.transparent_depth();
            m_scene.draw_transparent(m_insert, order);
        }
        const auto pass = timer.pass("composite", gl::Phase::finalization);
        const Pass drawing = begin();
        m_gl.TextureBarrier();
        const gl::Program& program = m_composite.program();
        program.set_texture("u_opaque", m_target.color());
        for (std::size_t i = 0; i < m_node_count; ++i)
            program.set_texture(("u_node_" + std::to_string(i)).c_str(), m_textures[i]);
        m_composite.draw();
    }

    Image frame_in(Order order, gl::FrameTimer& timer) const {
        render(timer, order);
        return m_target.read();
    }

    std::size_t m_node_count;
    gl::Program m_insert;
    FullscreenPass m_composite;
    std::vector<gl::Texture> m_textures;  ///< nodes, then depths
    gl::Framebuffer m_framebuffer;
};

}  // namespace

MethodInfo method_mlab() {
    return describe_method(
        {
            .id = "mlab",
            .name = "MLAB",
            .kind = "order-independent, exact for few layers",
            .summary =
                "Multi-layer alpha blending: a few sorted nodes per pixel; what finds no room is merged into the "
                "last one.",
            .paper = "Salvi and Vaidyanathan, Multi-Layer Alpha Blending, I3D 2014",
            .good_at =
                "One pass in bounded memory; exact for as many layers as nodes, for intersecting primitives too.",
            .bad_at = "With more layers the picture depends on the order of submission; needs framebuffer fetch.",
            .memory = "8 bytes per pixel and node, 16 with rgba32f; 16 per pixel for every four depths",
            .passes = "1, and a full-screen one",
            .needs = "framebuffer fetch",
            .needs_sorting = false,
        },
        MlabParameters::table(), make_new<Mlab>,
        [](const MlabParameters& parameters, int pixel_bytes) -> std::optional<double> {
            return parameters.nodes * (pixel_bytes == 16 ? 16 : 8) + 16 * depth_textures(parameters);
        });
}

}  // namespace sheer
