#include "renderer/scene/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>
#include <regex>
#include <stdexcept>

#include "renderer/core/errors.h"
#include "renderer/glsl/own_shading.h"
#include "renderer/scene/alpha_coverage.h"

namespace sheer {

namespace {

/// As in shaders/scenes/materials.glsl and material.glsl.
constexpr GLuint pictures_unit = 3, materials_binding = 4;
static_assert(pictures_unit + max_picture_arrays <= gl::first_named_texture_unit);

/// Null for a shading that belongs to one scene type.
const Shading* find_shading(const std::string& name) {
    const auto* found = std::ranges::find(shadings::all, name, &Shading::name);
    return found == std::end(shadings::all) ? nullptr : found;
}

std::string define(const std::string& name, int value) {
    return "#define " + name + " " + std::to_string(value) + "\n";
}

/// For shaders/scenes/material.glsl.
std::string material_defines(const Geometry& geometry) {
    const std::int32_t plain = sampling_bits({});
    const auto special = [&](const SurfaceMaterial& material) {
        return std::ranges::any_of(std::array{material.base, material.emission}, [&](const SurfacePicture& picture) {
            return picture.array >= 0 && picture.sampling != plain;
        });
    };
    const auto emits = [](const SurfaceMaterial& material) { return material.emitted != glm::vec3(0); };
    return define("PICTURE_ARRAYS", static_cast<int>(geometry.picture_arrays.arrays.size())) +
           define("SAMPLERS", std::ranges::any_of(geometry.materials, special)) +
           define("EMISSIVE", std::ranges::any_of(geometry.materials, emits));
}

/// Far to near; of equal depths, the one submitted earlier comes first.
void sort_far_to_near(std::vector<std::size_t>& order, const Geometry& geometry) {
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return geometry.primitives[a].depth > geometry.primitives[b].depth;
    });
}

bool has_one_tint_a_triangle(const Geometry& geometry) {
    const auto tint = [&](std::size_t i) -> const glm::vec4& { return geometry.vertices[geometry.indices[i]].tint; };
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3)
        if (tint(i) != tint(i + 1) || tint(i) != tint(i + 2)) return false;
    return true;
}

glm::vec4 screen_rect(const Geometry& geometry, const Primitive& primitive) {
    constexpr glm::vec4 everywhere{-1, -1, 2, 2};
    glm::vec2 least{1e30f}, greatest{-1e30f};
    for (std::uint32_t i = primitive.first_index; i < primitive.first_index + primitive.index_count; ++i) {
        const glm::vec4 clip = geometry.view_projection * glm::vec4(geometry.vertices[geometry.indices[i]].position, 1);
        if (clip.w <= 1e-6f) return everywhere;  // it may reach behind the eye
        const glm::vec2 fraction = glm::vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w);
        least = glm::min(least, fraction);
        greatest = glm::max(greatest, fraction);
    }
    return {least, greatest};
}

}  // namespace

Scene::Scene(const gl::Functions& gl, const Geometry& geometry, const nlohmann::json& parameters,
             const std::string& pointer)
    : m_gl(gl),
      m_parallel(geometry.parallel),
      m_flat_tint(has_one_tint_a_triangle(geometry)),
      m_alpha_is_given(m_flat_tint && parameters.at("shading") == shadings::constant.name),
      m_view_projection(geometry.view_projection),
      m_glsl_pointer(pointer + "/shading/glsl") {
    m_vertex_source =
        glsl_version + define("SHEER_FLAT_TINT", m_flat_tint) + std::string(gl::shader_file("scenes/scene.vert.glsl"));
    make_shading(geometry, parameters);
    make_materials(geometry);

    const Vertex none{};  // a GL buffer cannot be empty
    const bool empty = geometry.vertices.empty();
    m_vertices = gl::make_buffer(gl, "scene vertices",
                                 static_cast<GLsizeiptr>((empty ? 1 : geometry.vertices.size()) * sizeof(Vertex)),
                                 empty ? &none : geometry.vertices.data());
    m_vertex_array = gl::make_vertex_array(gl, "scene vertex array");
    m_no_attributes = gl::make_vertex_array(gl, "gathered scene");
    const GLuint array = m_vertex_array.id();
    gl.VertexArrayVertexBuffer(array, 0, m_vertices.id(), 0, sizeof(Vertex));
    gl.VertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
    gl.VertexArrayAttribFormat(array, 1, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, uv));
    gl.VertexArrayAttribFormat(array, 2, 4, GL_FLOAT, GL_FALSE, offsetof(Vertex, tint));
    gl.VertexArrayAttribIFormat(array, 3, 1, GL_UNSIGNED_INT, offsetof(Vertex, primitive));
    gl.VertexArrayAttribIFormat(array, 4, 1, GL_UNSIGNED_INT, offsetof(Vertex, material));
    for (GLuint attribute = 0; attribute < 5; ++attribute) {
        gl.VertexArrayAttribBinding(array, attribute, 0);
        gl.EnableVertexArrayAttrib(array, attribute);
    }
    if (!geometry.emission_uvs.empty()) add_emission_uvs(geometry.emission_uvs);

    for (const Primitive& primitive : geometry.primitives) m_screen_rects.push_back(screen_rect(geometry, primitive));
    std::vector<std::size_t> opaque, transparent;
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i)
        (geometry.primitives[i].opaque ? opaque : transparent).push_back(i);
    m_transparent_count = transparent.size();
    m_opaque = make_list(geometry, opaque, "opaque indices");
    m_opaque_index_count = static_cast<GLsizei>(m_opaque.first_index.back());
    m_lists[static_cast<int>(Order::submission)] = make_list(geometry, transparent, "indices in submission order");
    sort_far_to_near(transparent, geometry);
    m_lists[static_cast<int>(Order::far_to_near)] = make_list(geometry, transparent, "indices far to near");
    std::ranges::reverse(transparent);
    m_lists[static_cast<int>(Order::near_to_far)] = make_list(geometry, transparent, "indices near to far");
}

void Scene::add_emission_uvs(const std::vector<glm::vec2>& uvs) {
    constexpr GLuint attribute = 5, binding = 1;
    m_emission_uvs = gl::make_buffer(m_gl, "scene emission uvs",
                                     static_cast<GLsizeiptr>(uvs.size() * sizeof(glm::vec2)), uvs.data());
    const GLuint array = m_vertex_array.id();
    m_gl.VertexArrayVertexBuffer(array, binding, m_emission_uvs.id(), 0, sizeof(glm::vec2));
    m_gl.VertexArrayAttribFormat(array, attribute, 2, GL_FLOAT, GL_FALSE, 0);
    m_gl.VertexArrayAttribBinding(array, attribute, binding);
    m_gl.EnableVertexArrayAttrib(array, attribute);
}

Scene::DrawList Scene::make_list(const Geometry& geometry, const std::vector<std::size_t>& order,
                                 std::string_view label) const {
    DrawList list;
    std::vector<std::uint32_t> indices;
    for (const std::size_t i : order) {
        const Primitive& primitive = geometry.primitives[i];
        list.first_index.push_back(indices.size());
        list.primitives.push_back(static_cast<std::uint32_t>(i));
        const auto first = geometry.indices.begin() + primitive.first_index;
        indices.insert(indices.end(), first, first + primitive.index_count);
    }
    list.first_index.push_back(indices.size());
    if (indices.empty()) indices.push_back(0);  // a GL buffer cannot be empty
    list.indices =
        gl::make_buffer(m_gl, label, static_cast<GLsizeiptr>(indices.size() * sizeof(indices[0])), indices.data());
    return list;
}

void Scene::make_shading(const Geometry& geometry, const nlohmann::json& parameters) {
    m_shading_source = define("SHEER_HAS_CAMERA", !geometry.camera.is_null()) + define("SHEER_FLAT_TINT", m_flat_tint) +
                       std::string(gl::shader_file("scenes/inputs.glsl"));
    m_shading_source += define(
        "SHEER_MASKED",
        std::ranges::any_of(geometry.materials, [](const SurfaceMaterial& material) { return material.cutoff > 0; }));
    if (!geometry.materials.empty()) m_shading_source += gl::shader_file("scenes/materials.glsl");
    if (parameters.at("shading").is_object()) return add_own_shading(geometry, parameters);
    const auto name = parameters.at("shading").get<std::string>();
    if (const Shading* shading = find_shading(name)) {
        m_reads = m_most_iterations = shading->reads;
        m_reads_of_fragment = shading->reads;
        m_shading_source += define("TEXTURED", shading->reads > 0) + define("MATH", shading->math);
        m_shading_source += gl::shader_file("scenes/real_work.glsl");
        if (shading->reads > 0) make_textures(geometry, parameters.at("texture"));
    } else {
        m_shading_source += material_defines(geometry);
        m_shading_source += gl::shader_file("scenes/" + name + ".glsl");
        if (geometry.volume) m_volume = VolumeTextures(m_gl, *geometry.volume);
        m_most_iterations = geometry.volume ? 4 : 0;  // whether it is lit, and three axes
    }
}

void Scene::add_own_shading(const Geometry& geometry, const nlohmann::json& parameters) {
    const GlslShading own = make_glsl_shading(parameters.at("shading").at("glsl"));
    m_counts_iterations = own.has_loops;
    m_takes_derivatives = own.takes_derivatives;
    m_most_iterations = 1 + (own.has_loops ? iterations_per_fragment : 0);
    m_reads = 1;
    m_shading_source += define("SHEER_TEXTURED", own.is_textured) + define("SHEER_ITERATIONS", iterations_per_fragment);
    m_shading_source += gl::shader_file("scenes/glsl_shading.glsl");
    m_shading_source += own.function;
    m_shading_source += gl::shader_file("scenes/own_work.glsl");
    if (own.is_textured) make_textures(geometry, parameters.at("texture"));
}

void Scene::make_materials(const Geometry& geometry) {
    if (geometry.materials.empty()) return;
    m_materials = gl::make_buffer(m_gl, "scene materials",
                                  static_cast<GLsizeiptr>(geometry.materials.size() * sizeof(SurfaceMaterial)),
                                  geometry.materials.data());
    make_pictures(geometry);
}

void Scene::make_pictures(const Geometry& geometry) {
    const GLenum format = std::ranges::all_of(geometry.pictures, &Picture::eight_bit) ? GL_RGBA8 : GL_RGBA16F;
    for (const PictureArrays::Array& array : geometry.picture_arrays.arrays) {
        m_pictures.push_back(make_repeating_array("scene pictures"));
        const int longest = std::max(array.size_px.x, array.size_px.y);
        m_gl.TextureStorage3D(m_pictures.back().id(), static_cast<GLsizei>(std::bit_width(unsigned(longest))), format,
                              array.size_px.x, array.size_px.y, array.layers);
    }
    for (std::size_t i = 0; i < geometry.pictures.size(); ++i) {
        const PictureArrays::Place& place = geometry.picture_arrays.places[i];
        fill_layer(m_pictures[static_cast<std::size_t>(place.array)], place.layer, place.level,
                   make_mipmaps(geometry.pictures[i].image));
    }
}

gl::Texture Scene::make_repeating_array(std::string_view label) const {
    GLuint id = 0;
    m_gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
    gl::Texture texture(m_gl, id, label);
    m_gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    m_gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    m_gl.TextureParameteri(id, GL_TEXTURE_WRAP_S, GL_REPEAT);
    m_gl.TextureParameteri(id, GL_TEXTURE_WRAP_T, GL_REPEAT);
    return texture;
}

void Scene::fill_layer(const gl::Texture& texture, GLint layer, GLint first_level,
                       const std::vector<Image>& levels) const {
    for (std::size_t level = 0; level < levels.size(); ++level)
        m_gl.TextureSubImage3D(texture.id(), first_level + static_cast<GLint>(level), 0, 0, layer,
                               levels[level].width_px, levels[level].height_px, 1, GL_RGBA, GL_FLOAT,
                               levels[level].rgba.data());
}

void Scene::make_textures(const Geometry& geometry, const nlohmann::json& texture) {
    m_textures = make_repeating_array("scene textures");
    const nlohmann::json& image = texture.at("image");
    const auto size_px = texture.at("size").get<int>();
    const auto coverage_alpha = texture.at("coverage_alpha").get<double>();
    const auto file_of = [&](int layer) {
        const nlohmann::json& name = image.is_array() ? image[static_cast<std::size_t>(layer)] : image;
        const auto found = geometry.textures.find({name.get<std::string>(), size_px});
        return found == geometry.textures.end() ? nullptr : &found->second;
    };
    bool eight_bit = true;
    for (int layer = 0; layer < texture_count; ++layer)
        eight_bit = eight_bit && (file_of(layer) == nullptr || file_of(layer)->eight_bit);
    m_gl.TextureStorage3D(m_textures.id(), std::bit_width(static_cast<unsigned>(size_px)),
                          eight_bit ? GL_RGBA8 : GL_RGBA16F, size_px, size_px, texture_count);
    std::string last;
    std::vector<Image> levels;
    for (int layer = 0; layer < texture_count; ++layer) {
        const auto name = (image.is_array() ? image[static_cast<std::size_t>(layer)] : image).get<std::string>();
        const Picture* file = file_of(layer);
        if (file == nullptr) {
            std::vector<TextureLevel> painted = make_texture(name, size_px, layer);
            if (coverage_alpha > 0) keep_alpha_coverage(painted, coverage_alpha);
            fill_painted_layer(layer, painted);
            continue;
        }
        if (name != last) {
            levels = make_mipmaps(file->image);
            if (coverage_alpha > 0) keep_alpha_coverage(levels, coverage_alpha);
        }
        last = name;
        fill_layer(m_textures, layer, 0, levels);
    }
}

void Scene::fill_painted_layer(GLint layer, const std::vector<TextureLevel>& levels) const {
    for (std::size_t level = 0; level < levels.size(); ++level)
        m_gl.TextureSubImage3D(m_textures.id(), static_cast<GLint>(level), 0, 0, layer, levels[level].size_px,
                               levels[level].size_px, 1, GL_RGBA, GL_UNSIGNED_BYTE, levels[level].rgba.data());
}

gl::Program Scene::make_program(std::string_view label, std::string_view method_source,
                                const std::string& prolog) const {
    return build_program(label, m_vertex_source, m_shading_source, method_source, prolog);
}

gl::Program Scene::make_skipping_program(std::string_view label, std::string_view method_source,
                                         std::string_view skip_source, const std::string& prolog) const {
    const std::size_t after_version = std::string_view(glsl_version).size();
    return build_program(
        label,
        glsl_version + define("SHEER_SKIPS", 1) + m_vertex_source.substr(after_version) + std::string(skip_source),
        m_shading_source, method_source, prolog);
}

gl::Program Scene::make_gathering_program(std::string_view label, std::string_view method_source,
                                          const std::string& prolog) const {
    if (m_takes_derivatives)
        throw Unsupported(
            "the scene's own GLSL takes derivatives, which only neighbouring fragments of a primitive have");
    // What the pipeline says about the fragment is about the whole picture here.
    static const std::regex built_in("\\bgl_(FragCoord|FrontFacing)\\b");
    return build_program(label, gl::shader_file("common/fullscreen.vert.glsl"),
                         std::regex_replace(m_shading_source, built_in, "sheer_$1"), method_source,
                         define("SHEER_GATHERS", 1) + prolog);
}

gl::Program Scene::build_program(std::string_view label, const std::string& vertex_source,
                                 const std::string& shading_source, std::string_view method_source,
                                 const std::string& prolog) const {
    const std::string report = m_reports_loops ? define("SHEER_REPORT_LOOPS", loop_report_binding) : "";
    const std::string fragment = glsl_version + prolog + report + shading_source +
                                 std::string(gl::shader_file("scenes/count_shaded.glsl")) + std::string(method_source);
    try {
        return gl::Program(m_gl, label, vertex_source, fragment);
    } catch (const RenderError& error) {
        const std::string messages = user_messages(error.what());
        if (messages.empty()) throw;
        throw SpecError(std::vector<FieldError>{{m_glsl_pointer, "does not compile:\n" + messages}});
    }
}

void Scene::bind(const gl::Program& program, const gl::Buffer& indices) const {
    program.use();
    program.set("u_view_projection", m_view_projection);
    m_gl.BindVertexArray(m_vertex_array.id());
    m_gl.VertexArrayElementBuffer(m_vertex_array.id(), indices.id());
    bind_shading(program);
}

void Scene::bind_shading(const gl::Program& program) const {
    program.set("u_reads", m_reads);
    if (m_textures) m_gl.BindTextureUnit(0, m_textures.id());
    m_volume.bind(m_gl, program);
    if (m_materials) m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, materials_binding, m_materials.id());
    for (std::size_t array = 0; array < m_pictures.size(); ++array)
        m_gl.BindTextureUnit(pictures_unit + static_cast<GLuint>(array), m_pictures[array].id());
}

void Scene::bind_triangles(const gl::Program& program, Order order) const {
    program.set("u_view_projection", m_view_projection);
    m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, m_vertices.id());
    m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, list(order).indices.id());
    if (m_emission_uvs) m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, m_emission_uvs.id());
}

void Scene::gather(const gl::Program& program) const {
    if (m_observer) {
        m_observer->gather(program);
    } else {
        gather_unobserved(program);
    }
}

void Scene::gather_unobserved(const gl::Program& program) const {
    program.use();
    bind_shading(program);
    m_gl.BindVertexArray(m_no_attributes.id());
    m_gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

float Scene::least_alpha(double reference) const {
    constexpr double rounding = 0x1p-12;
    return static_cast<float>(m_alpha_is_given ? reference : reference - rounding);
}

std::size_t Scene::triangle_count(Order order, std::size_t first, std::size_t count) const {
    const DrawList& counted = list(order);
    return (counted.first_index[first + count] - counted.first_index[first]) / 3;
}

void Scene::draw_opaque(const gl::Program& program) const {
    if (!has_opaque()) return;
    bind(program, m_opaque.indices);
    m_gl.DrawElements(GL_TRIANGLES, m_opaque_index_count, GL_UNSIGNED_INT, nullptr);
}

void Scene::draw_transparent(const gl::Program& program, Order order) const {
    draw_transparent(program, order, 0, m_transparent_count);
}

void Scene::draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) const {
    if (m_observer) {
        m_observer->draw_transparent(program, order, first, count);
    } else {
        draw_unobserved(program, order, first, count);
    }
}

void Scene::draw_unobserved(const gl::Program& program, Order order, std::size_t first, std::size_t count) const {
    const DrawList& drawn = list(order);
    bind(program, drawn.indices);
    const std::size_t begin = drawn.first_index[first], end = drawn.first_index[first + count];
    program.set("u_first_triangle", static_cast<int>(begin / 3));
    m_gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - begin), GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(begin * sizeof(std::uint32_t)));
}

}  // namespace sheer
