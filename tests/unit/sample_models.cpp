#include "tests/unit/sample_models.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>
#include <numbers>

namespace sheer::test {

namespace {

using nlohmann::json;
using Color = std::array<double, 3>;
using Floats = std::vector<float>;

constexpr double pi = std::numbers::pi;
constexpr int repeat = 10497, clamp_to_edge = 33071, mirror = 33648, nearest = 9728, linear = 9729;

const Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white{1, 1, 1}, black{0, 0, 0}, behind = sample_background;

/// `color` with this opacity over the background.
Color over_background(const Color& color, double alpha) {
    Color mixed;
    for (std::size_t i = 0; i < 3; ++i) mixed[i] = alpha * color[i] + (1 - alpha) * behind[i];
    return mixed;
}

/// IEC 61966-2-1.
double encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

std::vector<ExpectedPixel> everywhere(const Color& color) {
    return {{2, 2, color}, {16, 16, color}, {29, 5, color}, {5, 29, color}, {29, 29, color}};
}

/// The four quarters of the picture: upper left, upper right, lower left, lower right.
std::vector<ExpectedPixel> quarters(const Color& a, const Color& b, const Color& c, const Color& d) {
    return {{8, 8, a}, {24, 8, b}, {8, 24, c}, {24, 24, d}};
}

const Floats quad_positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, quad_uvs = {0, 1, 1, 1, 1, 0, 0, 0};
const std::vector<std::uint16_t> quad_indices = {0, 1, 2, 0, 2, 3};

/// The attributes of a square that covers the picture.
json quad_attributes(GlbWriter& writer) {
    return {{"POSITION", writer.accessor(quad_positions, "VEC3")}, {"TEXCOORD_0", writer.accessor(quad_uvs, "VEC2")}};
}

/// A square with a material, in a node, which samples modify.
void add_quad(GlbWriter& writer, int material, json node = json::object()) {
    const json attributes = quad_attributes(writer);  // accessors 0 and 1
    const int indices = writer.accessor(quad_indices, "SCALAR");
    node["mesh"] = writer.mesh(attributes, indices, material);
    writer.root(node);
}

json& attributes(GlbWriter& writer) {
    return writer.document["meshes"][0]["primitives"][0]["attributes"];
}

/// Red, green in the upper row, blue, white in the lower one.
std::string four_colors() {
    return make_png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
}

int textured(GlbWriter& writer, const std::string& alpha_mode, const std::string& png, const json& sampler) {
    const int texture = writer.texture(png);
    writer.document["textures"][static_cast<std::size_t>(texture)]["sampler"] = writer.add("samplers", sampler);
    return writer.material(alpha_mode, {1, 1, 1, 1}, texture);
}

const json texel_sampler = {{"magFilter", nearest}, {"minFilter", nearest}};

/// A square with a texture whose coordinates go from `from` to `to` across it.
void add_textured_quad(GlbWriter& writer, const json& sampler, float from = 0, float to = 1,
                       const std::string& png = four_colors(), const std::string& alpha_mode = "OPAQUE") {
    add_quad(writer, textured(writer, alpha_mode, png, sampler));
    attributes(writer)["TEXCOORD_0"] = writer.accessor(Floats{from, to, to, to, to, from, from, from}, "VEC2");
}

json& base_texture(GlbWriter& writer) {
    return writer.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
}

void set_colors(GlbWriter& writer, const Floats& rgba) {
    attributes(writer)["COLOR_0"] = writer.accessor(rgba, "VEC4");
}

/// A masked square whose alpha is a factor, or comes from all its vertices.
SampleModel mask(const std::string& name, double factor, float vertices, double cutoff, const Color& seen) {
    return {name,
            [=](GlbWriter& writer) {
                add_quad(writer, writer.material("MASK", {0, 1, 0, factor}), {{"rotation", {0, 0.2, 0, 0.9797959}}});
                writer.document["materials"][0]["alphaCutoff"] = cutoff;
                Floats colors;
                for (int i = 0; i < 4; ++i) colors.insert(colors.end(), {1, 1, 1, vertices});
                set_colors(writer, colors);
            },
            {{16, 16, seen}, {10, 12, seen}, {22, 20, seen}, {13, 23, seen}, {16, 5, seen}}};
}

void add_draco_quad(GlbWriter& writer) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
              uvs = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (std::uint32_t face = 0; face < 2; ++face) {
        const auto corner = [&](std::size_t i) { return std::size_t{quad_indices[3 * face + i]}; };
        builder.SetAttributeValuesForFace(positions, draco::FaceIndex(face), &quad_positions[3 * corner(0)],
                                          &quad_positions[3 * corner(1)], &quad_positions[3 * corner(2)]);
        builder.SetAttributeValuesForFace(uvs, draco::FaceIndex(face), &quad_uvs[2 * corner(0)],
                                          &quad_uvs[2 * corner(1)], &quad_uvs[2 * corner(2)]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 12);
    draco::EncoderBuffer buffer;
    encoder.EncodeMeshToBuffer(*mesh, &buffer);
    const int view = writer.view({buffer.data(), buffer.size()});
    // Accessors without their own data, as the extension requires.
    const json attributes = {
        {"POSITION", writer.add("accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}})},
        {"TEXCOORD_0", writer.add("accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}})}};
    const int indices = writer.add("accessors", {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}});
    writer.root({{"mesh", writer.mesh(attributes, indices, textured(writer, "OPAQUE", four_colors(), texel_sampler))}});
    writer.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes",
         {{"POSITION", mesh->attribute(positions)->unique_id()}, {"TEXCOORD_0", mesh->attribute(uvs)->unique_id()}}}};
    writer.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
}

/// Replaces the bytes of an accessor's buffer view by compressed ones.
void compress(GlbWriter& writer, int accessor, const json& how, const std::vector<unsigned char>& bytes) {
    const int from = writer.view(std::string(bytes.begin(), bytes.end()));
    json& views = writer.document["bufferViews"];
    const int view = writer.document["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
    json extension = how;
    for (const char* name : {"buffer", "byteOffset", "byteLength"})
        extension[name] = views[static_cast<std::size_t>(from)][name];
    json& compressed = views[static_cast<std::size_t>(view)];
    compressed["extensions"]["EXT_meshopt_compression"] = extension;
    // The fallback buffer for readers without the extension is empty.
    writer.other_buffers = {
        {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    compressed["buffer"] = 1;
    compressed["byteOffset"] = 0;
}

void add_meshopt_quad(GlbWriter& writer) {
    add_quad(writer, textured(writer, "OPAQUE", four_colors(), texel_sampler));
    Floats filtered(12);
    meshopt_encodeFilterExp(filtered.data(), 4, 12, 15, quad_positions.data());
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12)),
        uvs(meshopt_encodeVertexBufferBound(4, 8)), indices(meshopt_encodeIndexBufferBound(6, 4));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), filtered.data(), 4, 12));
    uvs.resize(meshopt_encodeVertexBuffer(uvs.data(), uvs.size(), quad_uvs.data(), 4, 8));
    const std::vector<unsigned> corners(quad_indices.begin(), quad_indices.end());
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), 6));
    compress(writer, 0, {{"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}, {"byteStride", 12}, {"count", 4}},
             vertices);
    compress(writer, 1, {{"mode", "ATTRIBUTES"}, {"byteStride", 8}, {"count", 4}}, uvs);
    compress(writer, 2, {{"mode", "TRIANGLES"}, {"byteStride", 2}, {"count", 6}}, indices);
    writer.document["extensionsRequired"] = {"EXT_meshopt_compression"};
}

/// The left half is green, the right half blue, as OpenImageIO compresses it.
std::string make_webp() {
    constexpr int width_px = 32, height_px = 16;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < width_px * height_px; ++i)
        for (const int value : {0, i % width_px < 16 ? 255 : 0, i % width_px < 16 ? 0 : 255, 255})
            rgba.push_back(static_cast<std::uint8_t>(value));
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create("webp");
    OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::UINT8);
    output->set_ioproxy(&memory);
    if (!output->open("memory.webp", spec) || !output->write_image(OIIO::TypeDesc::UINT8, rgba.data()) ||
        !output->close())
        throw std::runtime_error(output->geterror());
    return {bytes.begin(), bytes.end()};
}

void add_webp_quad(GlbWriter& writer) {
    add_textured_quad(writer, texel_sampler);
    const int view = writer.view(make_webp());
    const int image = writer.add("images", {{"bufferView", view}, {"mimeType", "image/webp"}});
    writer.document["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = image;
    writer.document["extensionsRequired"] = {"EXT_texture_webp"};
}

void add_instances(GlbWriter& writer, const json& instance_attributes) {
    add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
    writer.document["nodes"][0]["scale"] = {0.25, 0.25, 1};
    writer.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = instance_attributes;
}

/// A sparse accessor that moves the quad's first two vertices, which are in the middle without it.
json sparse_positions(GlbWriter& writer, const std::vector<std::uint8_t>& numbers, const Floats& values) {
    const int indices = writer.accessor(numbers, "SCALAR"), positions = writer.accessor(values, "VEC3");
    const auto view = [&](int accessor) {
        return writer.document["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
    };
    return {{"count", numbers.size()},
            {"indices", {{"bufferView", view(indices)}, {"componentType", 5121}}},
            {"values", {{"bufferView", view(positions)}}}};
}

json camera(const std::array<double, 3>& eye, const std::array<double, 3>& target, double fov_y_deg) {
    return {{"camera", {{"eye", eye}, {"target", target}, {"fov_y_deg", fov_y_deg}}}};
}

/// -1..1 in the plane ten ahead of the eye.
const double sample_fov_deg = 2 * std::atan(0.1) * 180 / pi;

std::vector<SampleModel> geometry_samples() {
    return {
        {"Triangle",
         [](GlbWriter& writer) {
             const json attributes = {{"POSITION", writer.accessor(Floats{-1, -1, 0, 1, -1, 0, -1, 1, 0}, "VEC3")}};
             writer.root({{"mesh", writer.mesh(attributes,
                                               writer.accessor(std::vector<std::uint32_t>{0, 1, 2}, "SCALAR"), -1)}});
         },
         {{3, 6, white}, {25, 29, white}, {6, 29, white}, {25, 5, behind}}},
        {"TriangleWithoutIndices",
         [](GlbWriter& writer) {
             const json attributes = {{"POSITION", writer.accessor(Floats{1, 1, 0, -1, 1, 0, 1, -1, 0}, "VEC3")}};
             writer.root({{"mesh", writer.mesh(attributes, -1, -1)}});
         },
         {{4, 4, white}, {28, 4, white}, {4, 28, behind}, {28, 30, behind}}},
        {"TriangleStrip",
         [](GlbWriter& writer) {
             const json attributes = {
                 {"POSITION", writer.accessor(Floats{-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}, "VEC3")}};
             writer.root({{"mesh", writer.mesh(attributes, -1, -1)}});
             writer.document["meshes"][0]["primitives"][0]["mode"] = 5;
         },
         everywhere(white)},
        {"TriangleFan",
         [](GlbWriter& writer) {
             const json attributes = {{"POSITION", writer.accessor(quad_positions, "VEC3")}};
             writer.root({{"mesh", writer.mesh(attributes, -1, -1)}});
             writer.document["meshes"][0]["primitives"][0]["mode"] = 6;
         },
         everywhere(white)},
        {"LinesBesideTriangles",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {0, 1, 0, 1}), {{"scale", {0.5, 0.5, 1}}});
             json line = writer.document["meshes"][0]["primitives"][0];
             line["mode"] = 1;
             writer.document["meshes"][0]["primitives"].push_back(line);
         },
         {{16, 16, green}, {3, 3, behind}}},
        {"SimpleMeshes",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}),
                      {{"scale", {0.5, 0.5, 1}}, {"translation", {-0.5, 0.5, 0}}});
             writer.root({{"mesh", 0}, {"scale", {0.5, 0.5, 1}}, {"translation", {0.5, -0.5, 0}}});
         },
         quarters(red, behind, behind, red)},
        {"NestedRotation",
         [](GlbWriter& writer) {
             // A quarter turn to the left about z of what is on the right.
             const int mesh = writer.mesh(quad_attributes(writer), writer.accessor(quad_indices, "SCALAR"),
                                          writer.material("OPAQUE", {0, 0, 1, 1}));
             const int child =
                 writer.add("nodes", {{"mesh", mesh}, {"translation", {0.5, 0, 0}}, {"scale", {0.5, 1, 1}}});
             writer.root({{"children", {child}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
         },
         quarters(blue, blue, behind, behind)},
        {"NegativeScale",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}), {{"scale", {-1, 1, 1}}});
         },
         everywhere(red)},
        {"InterleavedBuffer",
         [](GlbWriter& writer) {
             Floats both;
             for (std::size_t i = 0; i < 4; ++i) {
                 both.insert(both.end(), &quad_positions[3 * i], &quad_positions[3 * i] + 3);
                 both.insert(both.end(), &quad_uvs[2 * i], &quad_uvs[2 * i] + 2);
             }
             std::string bytes(both.size() * sizeof(float), '\0');
             std::memcpy(bytes.data(), both.data(), bytes.size());
             add_quad(writer, textured(writer, "OPAQUE", four_colors(), texel_sampler));
             const int view = writer.view(bytes);
             writer.document["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 20;
             for (const std::size_t i : {0u, 1u}) writer.document["accessors"][i]["bufferView"] = view;
             writer.document["accessors"][1]["byteOffset"] = 12;
         },
         quarters(red, green, blue, white)},
        {"SparseAccessor",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             Floats flat = quad_positions;
             for (std::size_t i = 0; i < 6; ++i) flat[i] = 0;
             const int positions = writer.accessor(flat, "VEC3");
             writer.document["accessors"][static_cast<std::size_t>(positions)]["sparse"] =
                 sparse_positions(writer, {0, 1}, {-1, -1, 0, 1, -1, 0});
             attributes(writer)["POSITION"] = positions;
         },
         everywhere(red)},
        {"SparseAccessorWithoutBufferView",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             attributes(writer)["POSITION"] =
                 writer.add("accessors", {{"componentType", 5126},
                                          {"count", 4},
                                          {"type", "VEC3"},
                                          {"sparse", sparse_positions(writer, {0, 1, 2, 3}, quad_positions)}});
         },
         everywhere(red)},
        {"MeshQuantization",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             attributes(writer)["POSITION"] = writer.accessor(
                 std::vector<std::int16_t>{-100, -100, 0, 0, 100, -100, 0, 0, 100, 100, 0, 0, -100, 100, 0, 0}, "VEC4");
             json& accessor = writer.document["accessors"].back();
             accessor["type"] = "VEC3";
             writer.document["bufferViews"].back()["byteStride"] = 8;
             writer.document["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
             // 1023 of 65535, scaled by the texture transform, give 1.
             attributes(writer)["TEXCOORD_0"] =
                 writer.accessor(std::vector<std::uint16_t>{0, 1023, 1023, 1023, 1023, 0, 0, 0}, "VEC2", true);
             base_texture(writer)["extensions"]["KHR_texture_transform"]["scale"] = {65535.0 / 1023, 65535.0 / 1023};
             writer.document["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
         },
         quarters(red, green, blue, white)},
        {"DracoCompression", add_draco_quad, quarters(red, green, blue, white)},
        {"MeshoptCompression", add_meshopt_quad, quarters(red, green, blue, white)},
        {"GpuInstancing",
         [](GlbWriter& writer) {
             add_instances(writer, {{"TRANSLATION", writer.accessor(Floats{-2, 2, 0, 2, -2, 0}, "VEC3")}});
         },
         quarters(red, behind, behind, red)},
        {"GpuInstancingTurnsAndScales",
         [](GlbWriter& writer) {
             // The second one faces away from the eye.
             add_instances(writer,
                           {{"TRANSLATION", writer.accessor(Floats{-2, 2, 0, 2, -2, 0}, "VEC3")},
                            {"ROTATION",
                             writer.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4", true)},
                            {"SCALE", writer.accessor(Floats{2, 2, 1, 2, 2, 1}, "VEC3")}});
         },
         {{3, 3, red}, {13, 13, red}, {18, 18, behind}, {24, 24, behind}}},
        {"SkinAtRest",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}), {{"skin", 0}, {"translation", {50, 0, 0}}});
             writer.root({{"translation", {0, 3, 0}}});
             writer.add("skins", {{"joints", {1}}});
         },
         everywhere(red)},
        {"MorphTargetsAtRest",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             writer.document["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
         },
         everywhere(red)},
        {"HiddenNode",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             writer.root({{"mesh", 0}, {"translation", {0, 0, 1}}});
             writer.document["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
             writer.document["meshes"].push_back(writer.document["meshes"][0]);
             writer.document["nodes"][1]["mesh"] = 1;
             writer.document["meshes"][1]["primitives"][0]["material"] = writer.material("OPAQUE", {0, 1, 0, 1});
         },
         everywhere(red)},
        {"WebMercator",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             writer.document["nodes"][0]["translation"] = {13405321.25, 35.5, -4892765.75};
         },
         quarters(red, green, blue, white),
         camera({13405321.25, 35.5, -4892755.75}, {13405321.25, 35.5, -4892765.75}, sample_fov_deg)},
        {"Minute",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             writer.document["nodes"][0]["scale"] = {1e-9, 1e-9, 1e-9};
         },
         quarters(red, green, blue, white), camera({0, 0, 1e-8}, {0, 0, 0}, sample_fov_deg)},
        {"NearBeforeFar",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {0, 1, 0, 1}),
                      {{"scale", {1e7, 1e7, 1}}, {"translation", {0, 0, -1e5}}});
             writer.document["meshes"].push_back(writer.document["meshes"][0]);
             writer.document["meshes"][1]["primitives"][0]["material"] = writer.material("OPAQUE", {1, 0, 0, 1});
             writer.root({{"mesh", 1}, {"scale", {0.05, 0.05, 1}}, {"translation", {0, 0, 9}}});
         },
         {{16, 16, red}, {10, 10, red}, {3, 3, green}, {29, 29, green}}},
    };
}

std::vector<SampleModel> surface_samples() {
    return {
        {"OpaqueIgnoresAlpha",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 0.25}));
         },
         everywhere(red)},
        {"OpaqueIgnoresTheTexturesAlpha",
         [](GlbWriter& writer) {
             // Minified: every pixel is the mean of many texels, red with alpha 0 and green with alpha 1.
             add_textured_quad(writer, {{"minFilter", 9987}}, 0, 64, make_png(2, 1, {255, 0, 0, 0, 0, 255, 0, 255}));
         },
         everywhere({0.5, 0.5, 0})},
        {"Blend",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("BLEND", {1, 0, 0, 0.25}));
         },
         everywhere(over_background(red, 0.25))},
        {"BlendOverOpaque",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("BLEND", {1, 0, 0, 0.5}), {{"translation", {0, 0, 1}}});
             writer.document["meshes"].push_back(writer.document["meshes"][0]);
             writer.document["meshes"][1]["primitives"][0]["material"] = writer.material("OPAQUE", {0, 1, 0, 1});
             writer.root({{"mesh", 1}});
         },
         everywhere({0.5, 0.5, 0})},
        {"VertexColors",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 1, 1, 1}));
             set_colors(writer, {0.5, 0, 0.2f, 1, 0.5, 0, 0.2f, 1, 0.5, 0, 0.2f, 1, 0.5, 0, 0.2f, 1});
         },
         everywhere({encoded(0.5), 0, encoded(0.2)})},
        {"MaskByVertexAlpha",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("MASK", {0, 1, 0, 1}));
             set_colors(writer, {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0});  // from left to right
             writer.document["materials"][0]["alphaCutoff"] = 0.75;
         },
         {{2, 16, behind}, {22, 16, behind}, {25, 5, green}, {30, 28, green}}},
        mask("MaskAtItsCutoff", 0.5, 1, 0.5, green),
        mask("MaskJustUnderItsCutoff", 0.4999, 1, 0.5, behind),
        mask("MaskAtAnOddCutoff", 0.3, 1, 0.3, green),
        mask("MaskOfVerticesAtTheCutoff", 1, 0.7f, 0.7, green),
        mask("MaskOfBothAtTheCutoff", 0.6, 0.5, 0.3, green),
        mask("MaskOfBothUnderTheCutoff", 0.6, 0.5, 0.301, behind),
        mask("MaskWithoutCutoff", 0, 1, 0, green),
        mask("MaskOfOne", 1, 1, 1, green),
        mask("MaskOverOne", 1, 1, 1.5, behind),
        mask("MaskUnderOne", 0.999, 1, 1, behind),
        {"MaskOfATextureAtTheCutoff",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler, 0, 1, make_png(2, 1, {255, 0, 0, 128, 255, 0, 0, 127}), "MASK");
             writer.document["materials"][0]["alphaCutoff"] = 128.0 / 255;
         },
         quarters(red, behind, red, behind)},
        {"SingleSidedFromBehind",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
         },
         everywhere(behind), camera({0, 0, -10}, {0, 0, 0}, sample_fov_deg)},
        {"SingleSidedGlassFromBehind",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("BLEND", {1, 0, 0, 0.5}), {{"scale", {1, 1, -1}}});
         },
         everywhere(over_background(red, 0.5)), camera({0, 0, -10}, {0, 0, 0}, sample_fov_deg)},
        {"DoubleSidedFromBehind",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             writer.document["materials"][0]["doubleSided"] = true;
         },
         everywhere(red), camera({0, 0, -10}, {0, 0, 0}, sample_fov_deg)},
        {"DoubleSidedIsLitFromItsBack",
         [](GlbWriter& writer) {
             // A surface that lies face down shows its back, which faces up: lit by all of the sky and the sun's
             // cosine.
             add_quad(writer, writer.material("OPAQUE", {0.2, 0.2, 0.2, 1}),
                      {{"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
             writer.document["materials"][0]["doubleSided"] = true;
         },
         {{16,
           16,
           {encoded(0.2) * (0.38 + 0.8 * 0.8 / std::sqrt(1.1925)),
            encoded(0.2) * (0.43 + 0.75 * 0.8 / std::sqrt(1.1925)),
            encoded(0.2) * (0.52 + 0.62 * 0.8 / std::sqrt(1.1925))}}},
         {{"light", "daylight"},
          {"camera", {{"eye", {0, 10, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, -1}}, {"fov_y_deg", sample_fov_deg}}}}},
        {"Unlit",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {1, 0, 0, 1}));
             writer.document["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
         },
         everywhere(red),
         {{"light", "daylight"}}},
        {"Emissive",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {0.3, 0, 0, 1}));
             writer.document["materials"][0]["emissiveFactor"] = {0.2, 0.5, 0};
         },
         everywhere({encoded(0.5), encoded(0.5), 0})},
        {"EmissiveTextureAndStrength",
         [](GlbWriter& writer) {
             add_quad(writer, textured(writer, "OPAQUE", make_png(1, 1, {0, 0, 0, 255}), texel_sampler));
             json& material = writer.document["materials"][0];
             material["emissiveFactor"] = {0.125, 0.125, 0.125};
             material["emissiveTexture"]["index"] = writer.texture(four_colors());
             writer.document["textures"][1]["sampler"] = 0;
             material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
         },
         quarters({encoded(0.5), 0, 0}, {0, encoded(0.5), 0}, {0, 0, encoded(0.5)},
                  {encoded(0.5), encoded(0.5), encoded(0.5)})},
        {"Transmission",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("OPAQUE", {0, 0, 1, 0.1}));
             writer.document["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.75;
         },
         everywhere(over_background(blue, 0.25))},
        {"SpecularGlossiness",
         [](GlbWriter& writer) {
             add_quad(writer, writer.material("BLEND", {1, 1, 1, 1}));
             writer.document["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = {
                 1, 0, 0, 0.5};
         },
         everywhere(over_background(red, 0.5))},
    };
}

std::vector<SampleModel> texture_samples() {
    return {
        {"TextureRepeats",
         [](GlbWriter& writer) { add_textured_quad(writer, texel_sampler, -1, 1); },
         {{4, 4, red}, {12, 4, green}, {20, 4, red}, {28, 12, white}, {4, 28, blue}}},
        {"TextureClamps",
         [](GlbWriter& writer) {
             json sampler = texel_sampler;
             sampler["wrapS"] = clamp_to_edge;
             sampler["wrapT"] = clamp_to_edge;
             add_textured_quad(writer, sampler, -1, 3);
         },
         // The picture covers 8 to 16.
         {{2, 2, red}, {9, 9, red}, {30, 2, green}, {2, 30, blue}, {30, 30, white}, {11, 30, blue}, {13, 30, white}}},
        {"TextureMirrors",
         [](GlbWriter& writer) {
             json sampler = texel_sampler;
             sampler["wrapS"] = mirror;
             add_textured_quad(writer, sampler, -1, 1);
         },
         // Across: green, red, red, green; down it repeats.
         {{4, 4, green}, {12, 4, red}, {20, 4, red}, {28, 4, green}, {4, 12, white}, {28, 20, green}}},
        {"TextureClampsWhenFiltered",
         [](GlbWriter& writer) {
             add_textured_quad(writer, {{"wrapS", clamp_to_edge}, {"wrapT", clamp_to_edge}}, 0, 1,
                               make_png(2, 1, {255, 0, 0, 255, 0, 0, 255, 255}));
         },
         // Half a texel at either edge has a single color; with repetition the edges would be mixed.
         {{0, 16, red}, {6, 16, red}, {25, 16, blue}, {31, 16, blue}}},
        {"TextureIsFiltered",
         [](GlbWriter& writer) {
             add_textured_quad(writer, {{"magFilter", linear}, {"minFilter", linear}, {"wrapS", repeat}}, 0, 1,
                               make_png(2, 1, {255, 0, 0, 255, 0, 0, 255, 255}));
         },
         // u = 0.25 is the middle of red, 0.75 that of blue: at 11.5/32 there are 7/32 of a texel from the one to the
         // other
         // ... in steps of 1/256, which hardware may take.
         {{11, 16, {1 - 7 / 32.0, 0, 7 / 32.0}}, {20, 16, {7 / 32.0, 0, 1 - 7 / 32.0}}},
         json::object(),
         1.2 / 255},
        {"TextureIsNotFiltered",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler, 0, 1, make_png(2, 1, {255, 0, 0, 255, 0, 0, 255, 255}));
         },
         {{11, 16, red}, {15, 16, red}, {16, 16, blue}, {20, 16, blue}}},
        {"TextureWithoutMipmaps",
         [](GlbWriter& writer) {
             // Texel by texel, 64 of them a pixel: the middle of a pixel lies on the first of a pair.
             add_textured_quad(writer, texel_sampler, 0.015625f, 32.015625f, make_png(32, 1, [] {
                                   std::vector<std::uint8_t> rgba;
                                   for (int x = 0; x < 32; ++x)
                                       for (const int value : {x == 16 ? 255 : 0, 0, x == 16 ? 0 : 255, 255})
                                           rgba.push_back(static_cast<std::uint8_t>(value));
                                   return rgba;
                               }()));
         },
         everywhere(red)},
        {"TextureOfThreeByThree",
         [](GlbWriter& writer) {
             std::vector<std::uint8_t> rgba;
             for (int i = 0; i < 9; ++i)
                 for (const int value : {i == 4 ? 255 : 0, i == 4 ? 0 : 255, 0, 255})
                     rgba.push_back(static_cast<std::uint8_t>(value));
             add_textured_quad(writer, texel_sampler, 0, 1, make_png(3, 3, rgba));
         },
         // The middle third is 10.67 to 21.33.
         {{16, 16, red}, {11, 11, red}, {20, 20, red}, {9, 16, green}, {22, 16, green}, {16, 9, green}}},
        {"TexturesOfTwoSizes",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             writer.document["nodes"][0]["translation"] = {0.5, 0, 0};
             writer.document["nodes"][0]["scale"] = {0.5, 1, 1};
             writer.document["meshes"].push_back(writer.document["meshes"][0]);
             writer.document["meshes"][1]["primitives"][0]["material"] = textured(
                 writer, "OPAQUE", make_png(1, 3, {0, 0, 255, 255, 255, 0, 0, 255, 0, 0, 255, 255}), texel_sampler);
             writer.root({{"mesh", 1}, {"translation", {-0.5, 0, 0}}, {"scale", {0.5, 1, 1}}});
         },
         {{8, 9, blue}, {8, 11, red}, {8, 20, red}, {8, 22, blue}, {20, 8, red}, {28, 8, green}, {28, 24, white}}},
        {"TextureTransformOffsetAndScale",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             base_texture(writer)["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0}},
                                                                            {"scale", {0.5, 0.5}}};
         },
         everywhere(green)},
        {"TextureTransformRotation",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             // The coordinates turn to the left about the upper left corner, so the picture to the right; it repeats.
             base_texture(writer)["extensions"]["KHR_texture_transform"]["rotation"] = pi / 2;
         },
         quarters(blue, red, white, green)},
        {"TextureTransformPicksCoordinates",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler, 5, 6);
             attributes(writer)["TEXCOORD_3"] = writer.accessor(Floats{0, 0.5, 0.5, 0.5, 0.5, 0, 0, 0}, "VEC2");
             base_texture(writer)["extensions"]["KHR_texture_transform"]["texCoord"] = 3;
         },
         everywhere(red)},
        {"MultiUv",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             attributes(writer)["TEXCOORD_1"] = writer.accessor(Floats{0.5, 1, 1, 1, 1, 0.5, 0.5, 0.5}, "VEC2");
             base_texture(writer)["texCoord"] = 1;
         },
         everywhere(white)},
        {"EmissionHasCoordinatesOfItsOwn",
         [](GlbWriter& writer) {
             add_textured_quad(writer, texel_sampler);
             attributes(writer)["TEXCOORD_1"] = writer.accessor(Floats{0, 0.5, 0.5, 0.5, 0.5, 0, 0, 0}, "VEC2");
             writer.document["materials"][0]["emissiveFactor"] = {1, 1, 1};
             writer.document["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
         },
         quarters(red, {1, 1, 0}, {1, 0, 1}, white)},
        {"WebpTexture", add_webp_quad, quarters(green, blue, green, blue), json::object(), 0.03},
    };
}

}  // namespace

json sample_scene() {
    json scene = camera({0, 0, 10}, {0, 0, 0}, sample_fov_deg);
    scene["light"] = "none";
    return scene;
}

const std::vector<SampleModel>& sample_models() {
    static const std::vector<SampleModel> models = [] {
        std::vector<SampleModel> all;
        for (const auto& part : {geometry_samples(), surface_samples(), texture_samples()})
            all.insert(all.end(), part.begin(), part.end());
        return all;
    }();
    return models;
}

}  // namespace sheer::test
