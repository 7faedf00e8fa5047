// Models from glTF files that the tests write themselves: accepted ones, and refused ones with their reasons.
#include "renderer/assets/read_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/core/random.h"
#include "tests/unit/glb_writer.h"
#include "tests/unit/temporary_folder.h"

namespace sheer::test::read_model_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// One triangle in the plane z = 0.
GlbWriter one_triangle() {
    GlbWriter writer;
    writer.root({{"mesh", writer.mesh({{"POSITION", writer.accessor(triangle, "VEC3")}}, -1, -1)}});
    return writer;
}

/// A bit of everything: three alpha modes, vertex colors, normals, an embedded picture, nested nodes, indices.
GlbWriter rich() {
    GlbWriter writer;
    const std::vector<std::uint8_t> checker = {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 255};
    const int texture = writer.texture(make_png(2, 2, checker));
    const int positions = writer.accessor(std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3");
    const int normals = writer.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uvs = writer.accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
    const int colors = writer.accessor(
        std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 51}, "VEC4", true);
    const int indices = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
    const json attributes = {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}};
    const int masked = writer.mesh(attributes, indices, writer.material("MASK", {1, 1, 1, 1}, texture));
    writer.document["materials"][0]["alphaCutoff"] = 0.25;
    const int glass = writer.mesh({{"POSITION", positions}, {"COLOR_0", colors}}, indices,
                                  writer.material("BLEND", {1, 0.5, 0, 0.5}));
    const int solid = writer.mesh(attributes, indices, writer.material("OPAQUE", {0.25, 0.5, 1, 1}));
    const int child = writer.add("nodes", {{"mesh", glass}, {"scale", {2, 2, 2}}});
    const int middle = writer.add("nodes", {{"children", {child}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}});
    writer.root({{"mesh", masked}, {"children", {middle}}, {"translation", {10, 0, 0}}});
    writer.root({{"mesh", solid}});
    return writer;
}

Model read(const std::string& bytes) {
    return read_model(bytes, no_other_files);
}

/// Where the vertex is in the file's space.
glm::vec3 place(const Model& model, const ModelVertex& vertex) {
    return glm::vec3(model.origin + glm::dvec3(vertex.position));
}

std::string refusal(const std::string& bytes, const OtherFiles& others = no_other_files) {
    try {
        read_model(bytes, others);
    } catch (const AssetError& error) {
        return error.what();
    }
    return "was read";
}

TEST(ReadModel, OneTriangle) {
    const GlbWriter writer = one_triangle();
    for (const std::string& bytes : {writer.glb(), writer.gltf()}) {
        const Model model = read(bytes);
        ASSERT_EQ(model.parts.size(), 1u);
        EXPECT_THAT(model.parts[0].indices, ElementsAre(0, 1, 2));
        ASSERT_EQ(model.parts[0].vertices.size(), 3u);
        EXPECT_EQ(place(model, model.parts[0].vertices[1]), glm::vec3(1, 0, 0));
        // The file has no normals, so the triangle's own normal is used.
        EXPECT_EQ(model.parts[0].vertices[2].normal, glm::vec3(0, 0, 1));
        ASSERT_EQ(model.materials.size(), 1u);
        EXPECT_EQ(model.materials[0].alpha, Material::Alpha::opaque);
        EXPECT_EQ(model.materials[0].base_color, glm::vec4(1));
        EXPECT_TRUE(model.pictures.empty());
    }
}

TEST(ReadModel, MaterialsColorsAndPictures) {
    for (const std::string& bytes : {rich().glb(), rich().gltf()}) {
        const Model model = read(bytes);
        ASSERT_EQ(model.parts.size(), 3u);
        const ModelPart &masked = model.parts[0], &glass = model.parts[1], &solid = model.parts[2];
        const Material& mask = model.materials[masked.material];
        EXPECT_EQ(mask.alpha, Material::Alpha::mask);
        EXPECT_EQ(mask.cutoff, 0.25f);
        ASSERT_EQ(mask.base.picture, 0);
        ASSERT_EQ(model.pictures.size(), 1u);
        const Image& picture = model.pictures[0].image;
        EXPECT_EQ(std::make_pair(picture.width_px, picture.height_px), std::make_pair(2, 2));
        EXPECT_TRUE(model.pictures[0].eight_bit);
        EXPECT_EQ(picture.pixel(1, 0)[1], 1);
        EXPECT_EQ(picture.pixel(1, 0)[3], 0);
        EXPECT_EQ(masked.vertices[2].uv, glm::vec2(1, 0));
        // sRGB of 0.5 is 1.055 * 0.5^(1/2.4) - 0.055 = 0.735357; of 0.25 it is 0.537099.
        const Material& amber = model.materials[glass.material];
        EXPECT_EQ(amber.alpha, Material::Alpha::blend);
        EXPECT_EQ(amber.base.picture, -1);
        EXPECT_NEAR(amber.base_color.g, 0.735357, 1e-6);
        EXPECT_EQ(amber.base_color.b, 0);
        EXPECT_EQ(amber.base_color.a, 0.5f);
        EXPECT_NEAR(model.materials[solid.material].base_color.r, 0.537099, 1e-6);
        // Without normals every triangle has vertices of its own: corner 5 is vertex 3 of the file.
        EXPECT_EQ(glass.vertices.size(), 6u);
        EXPECT_NEAR(glass.vertices[5].color.a, 0.2, 1e-7);
        EXPECT_EQ(glass.vertices[0].color, glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(solid.vertices.size(), 4u);
    }
}

/// By hand: (1, -1, 0) doubled, turned by 90 degrees about y (x to -z, z to x), moved by 10 along x.
TEST(ReadModel, NestedNodesMoveTurnAndScale) {
    const Model model = read(rich().glb());
    const ModelPart& glass = model.parts[1];
    const glm::vec3 expected(10, -2, -2);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(place(model, glass.vertices[1])[axis], expected[axis], 1e-5);
        EXPECT_NEAR(glass.vertices[1].normal[axis], axis == 0, 1e-6);
    }
}

/// Mirroring reverses the order of the corners, but not the side that a surface faces; squeezing turns normals in the
/// opposite sense.
TEST(ReadModel, NormalsUnderMirrorAndSqueeze) {
    GlbWriter writer = one_triangle();
    writer.document["nodes"][0]["scale"] = {-1, 1, 1};
    EXPECT_EQ(read(writer.glb()).parts[0].vertices[0].normal, glm::vec3(0, 0, 1));
    const float half = std::sqrt(0.5f);
    writer.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        writer.accessor(std::vector<float>{half, half, 0, half, half, 0, half, half, 0}, "VEC3");
    writer.document["nodes"][0]["scale"] = {-2, 1, 1};
    const glm::vec3 normal = read(writer.glb()).parts[0].vertices[0].normal;
    EXPECT_NEAR(normal.x, -1 / std::sqrt(5.0), 1e-6);
    EXPECT_NEAR(normal.y, 2 / std::sqrt(5.0), 1e-6);
    // Squeezed flat, a normal along the plane has no direction.
    writer.document["nodes"][0]["scale"] = {1, 1, 0};
    EXPECT_EQ(read(writer.glb()).parts[0].vertices[0].normal, glm::vec3(0, 0, 0));
}

TEST(ReadModel, MatrixIsByColumns) {
    GlbWriter writer = one_triangle();
    writer.document["nodes"][0]["matrix"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    const Model model = read(writer.glb());
    EXPECT_EQ(place(model, model.parts[0].vertices[1]), glm::vec3(5, 7, 7));
}

/// Section 3.7.2.1: a strip's odd triangles are reversed; all triangles of a fan share the first corner.
TEST(ReadModel, StripsAndFans) {
    GlbWriter writer;
    const int positions = writer.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 2, 1, 0, 3, 1, 0, 4, 2, 0}, "VEC3");
    const int mesh = writer.mesh({{"POSITION", positions}, {"NORMAL", positions}}, -1, -1);
    writer.root({{"mesh", mesh}});
    json& primitive = writer.document["meshes"][0]["primitives"][0];
    const auto corners = [&] {
        const Model model = read(writer.glb());
        std::vector<float> numbers;  // x is the number of the vertex
        for (const std::uint32_t index : model.parts[0].indices)
            numbers.push_back(place(model, model.parts[0].vertices[index]).x);
        return numbers;
    };
    primitive["mode"] = 5;
    EXPECT_THAT(corners(), ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
    primitive["mode"] = 6;
    EXPECT_THAT(corners(), ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
    primitive["mode"] = 1;
    EXPECT_THAT(refusal(writer.glb()), HasSubstr("no triangles"));
    primitive["mode"] = 7;
    EXPECT_THAT(refusal(writer.glb()), HasSubstr("mesh 0, primitive 0: there is no mode 7"));
}

TEST(ReadModel, StridesAndWholeNumbers) {
    GlbWriter writer;
    // Positions as bytes with a stride of 8, divided by 127; KHR_mesh_quantization allows them.
    std::vector<std::int8_t> bytes(24);
    bytes[8] = 127;
    bytes[17] = -128;
    const int positions = writer.accessor(bytes, "VEC3", true);
    writer.document["accessors"][0]["count"] = 3;
    writer.document["bufferViews"][0]["byteStride"] = 8;
    writer.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    writer.root({{"mesh", writer.mesh({{"POSITION", positions}},
                                      writer.accessor(std::vector<std::uint8_t>{2, 1, 0}, "SCALAR"), -1)}});
    const Model model = read(writer.glb());
    EXPECT_EQ(place(model, model.parts[0].vertices[0]), glm::vec3(0, -1, 0));
    EXPECT_EQ(place(model, model.parts[0].vertices[1]), glm::vec3(1, 0, 0));
}

/// Pictures that are not used as base colors are not even read.
TEST(ReadModel, PicturesKeepTheirSizes) {
    GlbWriter writer;
    const int large = writer.texture(make_png(5, 3, std::vector<std::uint8_t>(5 * 3 * 4, 128)));
    const int small = writer.texture(make_png(1, 1, {255, 255, 255, 255}));
    writer.texture("not a picture at all");
    const int positions = writer.accessor(triangle, "VEC3"), uvs = writer.accessor(std::vector<float>(6), "VEC2");
    for (const int texture : {large, small, large})
        writer.root({{"mesh", writer.mesh({{"POSITION", positions}, {"TEXCOORD_0", uvs}}, -1,
                                          writer.material("OPAQUE", {1, 1, 1, 1}, texture))}});
    const Model model = read(writer.glb());
    ASSERT_EQ(model.pictures.size(), 2u);
    EXPECT_EQ(model.materials.size(), 3u);
    EXPECT_EQ(model.pictures[0].image.width_px, 5);
    EXPECT_EQ(model.pictures[0].image.height_px, 3);
    EXPECT_EQ(model.pictures[1].image.width_px, 1);
}

TEST(ReadModel, FilesBesideIt) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "model");
    std::filesystem::create_directory(folder.path() / "model/parts");
    GlbWriter writer = one_triangle();
    folder.file("model/parts/my data.bin", writer.binary);
    folder.file("outside.bin", writer.binary);
    std::filesystem::create_symlink(folder.path() / "outside.bin", folder.path() / "model/link.bin");
    const auto with_uri = [&](const std::string& uri) {
        json document = writer.document;
        document["buffers"] = {{{"byteLength", writer.binary.size()}, {"uri", uri}}};
        return document.dump();
    };
    const OtherFiles others = files_below(folder.path() / "model");
    EXPECT_EQ(read_model(with_uri("parts/my%20data.bin"), others).parts.size(), 1u);
    EXPECT_THAT(refusal(with_uri("parts/my%20data.bin")), HasSubstr("needs another file, \"parts/my data.bin\""));
    EXPECT_THAT(refusal(with_uri("missing.bin"), others),
                HasSubstr("\"missing.bin\", which does not exist: " + (folder.path() / "model/missing.bin").string()));
    for (const char* uri : {"../outside.bin", "link.bin", "/etc/hostname", "parts/../../outside.bin"})
        EXPECT_THAT(refusal(with_uri(uri), others), HasSubstr("not in its folder")) << uri;
    EXPECT_THAT(refusal(with_uri("http://example.org/a.bin"), others), HasSubstr("does not exist"));
    // A .glb may name other files, too.
    EXPECT_THAT(refusal(GlbWriter::wrap(with_uri("a.bin"), "")), HasSubstr("needs another file, \"a.bin\""));
}

TEST(ReadModel, CutOffAnywhereIsRefused) {
    const std::string whole = rich().glb();
    for (std::size_t length = 0; length < whole.size(); length += length < 200 ? 1 : 37) {
        EXPECT_NE(refusal(whole.substr(0, length)), "was read") << length;
        if (length < 20) continue;
        // The same with a corrected length in the header.
        std::string mended = whole.substr(0, length);
        mended.replace(8, 4, little_endian(length, 4));
        EXPECT_NE(refusal(mended), "was read") << length;
    }
    EXPECT_THAT(refusal(whole.substr(0, 1000)), HasSubstr("cut off: it has 1000 bytes"));
}

/// A change to a valid file, and a part of the reason for which it is refused.
struct Broken {
    std::string name;
    std::function<void(GlbWriter&)> change;
    std::string reason;
};

void PrintTo(const Broken& broken, std::ostream* out) {
    *out << broken.name;
}

class BrokenModel : public testing::TestWithParam<Broken> {};

TEST_P(BrokenModel, IsRefusedWithTheReason) {
    GlbWriter writer = rich();
    GetParam().change(writer);
    EXPECT_THAT(refusal(writer.glb()), HasSubstr(GetParam().reason));
}

/// Sets the value at `pointer`.
std::function<void(GlbWriter&)> set(const char* pointer, const json& value) {
    return [pointer, value](GlbWriter& writer) { writer.document[json::json_pointer(pointer)] = value; };
}

/// Puts a float into the binary chunk, `offset` bytes into an accessor's buffer view.
std::function<void(GlbWriter&)> poke(int accessor, std::size_t offset, float value) {
    return [=](GlbWriter& writer) {
        const int view = writer.document["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
        const std::size_t at = writer.document["bufferViews"][static_cast<std::size_t>(view)]["byteOffset"];
        std::memcpy(&writer.binary[at + offset], &value, sizeof value);
    };
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint64_t huge = 0xffffffffffffff00u;

INSTANTIATE_TEST_SUITE_P(
    All, BrokenModel,
    testing::Values(
        Broken{"Version1", set("/asset/version", "1.0"), "version 1.0"},
        Broken{"NoVersion", set("/asset", json::object()), "asset.version"},
        Broken{"RequiredExtension", set("/extensionsRequired", {"KHR_lights_punctual", "KHR_texture_basisu"}),
               "needs the extension KHR_texture_basisu"},
        Broken{"Draco",
               set("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
                   {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}),
               "mesh 0, primitive 0: KHR_draco_mesh_compression cannot be decoded: Not a Draco file"},
        Broken{"Meshopt",
               set("/bufferViews/1/extensions/EXT_meshopt_compression",
                   {{"buffer", 0}, {"byteLength", 40}, {"byteStride", 12}, {"count", 4}, {"mode", "ATTRIBUTES"}}),
               "buffer view 1: EXT_meshopt_compression: the compressed data cannot be decoded"},
        Broken{"MeshoptTooLarge",
               set("/bufferViews/1/extensions/EXT_meshopt_compression",
                   {{"buffer", 0}, {"byteLength", 40}, {"byteStride", 12}, {"count", huge}, {"mode", "ATTRIBUTES"}}),
               "decodes to more than"},
        Broken{"MeshoptStride",
               set("/bufferViews/1/extensions/EXT_meshopt_compression",
                   {{"buffer", 0}, {"byteLength", 40}, {"byteStride", 3}, {"count", 4}, {"mode", "TRIANGLES"}}),
               "byteStride cannot be 3 if mode is TRIANGLES"},
        Broken{"IndexBeyondVertices", set("/accessors/4/bufferView", 1), "is not one of the 4 vertices"},
        Broken{"IndicesAsFloats", set("/meshes/0/primitives/0/indices", 0), "numbers per element"},
        Broken{"IndicesMissing", set("/meshes/0/primitives/0/indices", 99), "indices: there is no accessor 99"},
        Broken{"PositionMissing", set("/meshes/0/primitives/0/attributes", {{"NORMAL", 1}}), "has no POSITION"},
        Broken{"PositionOfWrongType", set("/meshes/0/primitives/0/attributes/POSITION", 2), "2 numbers per element"},
        Broken{"AttributeNotThere", set("/meshes/0/primitives/0/attributes/NORMAL", 77), "accessor 77"},
        Broken{"AttributeNegative", set("/meshes/0/primitives/0/attributes/NORMAL", -3),
               "NORMAL must be a whole number of at least 0"},
        Broken{"CountsDiffer", set("/accessors/1/count", 3), "has 3 elements, but POSITION has 4"},
        Broken{"AccessorTooLong", set("/accessors/0/count", 5), "exceed its buffer view"},
        Broken{"AccessorVeryLong", set("/accessors/0/count", huge), "exceed its buffer view"},
        Broken{"AccessorOffset", set("/accessors/0/byteOffset", huge), "exceed its buffer view"},
        Broken{"AccessorEmpty", set("/accessors/0/count", 0), "is empty"},
        Broken{"AccessorOfDoubles", set("/accessors/0/componentType", 5130), "component type 5130"},
        Broken{"AccessorWithoutView", set("/accessors/1/bufferView", -1),
               "accessor 1: bufferView must be a whole number of at least 0"},
        Broken{"SparseWithoutValues", set("/accessors/1/sparse", {{"count", 1}}),
               "is sparse without indices or values"},
        Broken{"SparseIndexBeyond",
               set("/accessors/1/sparse", {{"count", 1},
                                           {"indices", {{"bufferView", 4}, {"byteOffset", 4}, {"componentType", 5125}}},
                                           {"values", {{"bufferView", 1}}}}),
               "NORMAL is sparse: "},
        Broken{"SparseValuesBeyond",
               set("/accessors/1/sparse", {{"count", 4},
                                           {"indices", {{"bufferView", 5}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", 5}}}}),
               "exceed its buffer view"},
        Broken{"ZerosWithoutEnd",
               set("/accessors/1", {{"count", 4000000000u}, {"componentType", 5126}, {"type", "VEC3"}}),
               "4000000000 elements; a sparse accessor may have at most"},
        Broken{"StrideTooSmall", set("/bufferViews/1/byteStride", 4), "stride smaller"},
        Broken{"ViewBeyondBuffer", set("/bufferViews/1/byteLength", 100000), "exceeds"},
        Broken{"ViewOffsetBeyondBuffer", set("/bufferViews/1/byteOffset", huge), "exceeds"},
        Broken{"ViewOfNoBuffer", set("/bufferViews/1/buffer", 1), "there is no buffer 1"},
        Broken{"ViewNegative", set("/bufferViews/1/byteOffset", -4), "whole number of at least 0"},
        Broken{"ImageOfNoView", set("/images/0/bufferView", 55), "there is no buffer view 55"},
        Broken{"ImageNotAPicture", set("/images/0/bufferView", 1), "image 0: "},
        Broken{"ImageElsewhere", set("/images/0", {{"uri", "wood.png"}}), "\"wood.png\""},
        Broken{"TextureNotThere", set("/materials/0/pbrMetallicRoughness/baseColorTexture/index", 8),
               "material 0: there is no texture 8"},
        Broken{"TextureOfNoImage", set("/textures/0/source", 3), "there is no image 3"},
        Broken{"TextureWithoutCoordinates", set("/meshes/0/primitives/0/attributes", {{"POSITION", 0}}),
               "has a texture but no TEXCOORD_0"},
        Broken{"MaterialNotThere", set("/meshes/0/primitives/0/material", 9), "there is no material 9"},
        Broken{"AlphaModeUnknown", set("/materials/1/alphaMode", "GLASS"), "not \"GLASS\""},
        Broken{"NodeBelowItself", set("/nodes/0/children", {1}), "must form trees"},
        Broken{"NodeBelowTwo", set("/nodes/3/children", {0}), "must form trees"},
        Broken{"NodeNotThere", set("/nodes/1/children", {12}), "there is no node 12"},
        Broken{"SceneNotThere", set("/scene", 4), "there is no scene 4"},
        Broken{"NoScene", set("/scenes", json::array()), "no scene"},
        Broken{"MeshNotThere", set("/nodes/3/mesh", 30), "there is no mesh 30"},
        Broken{"MatrixTooShort", set("/nodes/3/matrix", {1, 2, 3}), "matrix must have 16 numbers, not 3"},
        Broken{"RotationWithoutLength", set("/nodes/1/rotation", {0, 0, 0, 0}), "has no length"},
        Broken{"MovedAway", set("/nodes/2/translation", {1e300, 0, 0}), "farther out"},
        Broken{"PositionNotANumber", poke(0, 4, nan), "POSITION: element 0 is not a finite number"},
        Broken{"NormalNotANumber", poke(1, 12, nan), "NORMAL: element 1 is not a finite number"},
        Broken{"UvInfinite", poke(2, 0, std::numeric_limits<float>::infinity()), "TEXCOORD_0: element 0"},
        Broken{"ImagesNotAList", set("/images", 1), "images is not a list"}),
    [](const testing::TestParamInfo<Broken>& row) { return row.param.name; });

TEST(ReadModel, BuffersThatAreMissing) {
    const GlbWriter writer = one_triangle();
    json document = writer.document;
    const std::size_t size = writer.binary.size();
    document["buffers"] = {{{"byteLength", size}}};
    EXPECT_THAT(refusal(document.dump()), HasSubstr("buffer 0 is missing: it has no uri"));
    EXPECT_THAT(refusal(GlbWriter::wrap(document.dump(), "")), HasSubstr("no binary chunk"));
    EXPECT_THAT(refusal(GlbWriter::wrap(document.dump(), writer.binary.substr(0, 32))), HasSubstr("only 32 exist"));
    document["buffers"].push_back({{"byteLength", size}});
    document["bufferViews"][0]["buffer"] = 1;
    EXPECT_THAT(refusal(GlbWriter::wrap(document.dump(), writer.binary)), HasSubstr("buffer 1 is missing"));
    document["bufferViews"][0]["buffer"] = 0;
    document["buffers"] = {{{"byteLength", size}, {"uri", "data:application/octet-stream;base64,AAAA"}}};
    EXPECT_NE(refusal(document.dump()), "was read");
}

TEST(ReadModel, FilesThatAreNotGltf) {
    EXPECT_THAT(refusal(""), HasSubstr("neither a .glb"));
    EXPECT_THAT(refusal("\x89PNG\r\n\x1a\n"), HasSubstr("neither a .glb"));
    EXPECT_THAT(refusal("glTF"), HasSubstr("ends within its header"));
    EXPECT_THAT(refusal("{\"asset\": "), HasSubstr("JSON cannot be read"));
    EXPECT_THAT(refusal("{}"), HasSubstr("asset.version"));
    EXPECT_THAT(refusal(GlbWriter::wrap("[1, 2, 3]", "")), HasSubstr("not an object"));
    EXPECT_THAT(refusal(GlbWriter::wrap("{\"asset\" 1}", "")), HasSubstr("JSON cannot be read"));
    EXPECT_THAT(refusal("glTF" + little_endian(1, 4) + little_endian(12, 4)), HasSubstr("version 1"));
    EXPECT_THAT(refusal("{\"asset\": {\"version\": \"2.0\", \"extras\": " + std::string(100000, '[')),
                HasSubstr("nested more than 100 deep"));
    EXPECT_THAT(refusal(one_triangle().document.dump()), HasSubstr("there is no buffer 0"));
    // The binary chunk is said to reach 8 bytes beyond the end.
    std::string bytes = one_triangle().glb();
    const std::size_t chunk = bytes.size() - 36 - 8;
    bytes.replace(chunk, 4, little_endian(44, 4));
    EXPECT_THAT(refusal(bytes), HasSubstr("chunk 1 of the file has 44 bytes, but only 36 are left"));
}

/// Small files that need much memory: nodes may repeat a mesh, and accessors a buffer view.
TEST(ReadModel, LimitsApplyBeforeMemoryIsAllocated) {
    GlbWriter writer;
    const int positions = writer.accessor(std::vector<float>(299997), "VEC3");
    const int mesh = writer.mesh({{"POSITION", positions}}, -1, -1);
    for (int i = 0; i < 200; ++i) writer.root({{"mesh", mesh}});
    EXPECT_THAT(refusal(writer.glb()), HasSubstr("more than"));
    GlbWriter many = one_triangle();
    for (int i = 0; i < 100001; ++i) many.add("cameras", json::object());
    EXPECT_THAT(refusal(many.glb()), HasSubstr("100001 cameras"));
}

/// Files of common exporters that are not quite valid glTF.
TEST(ReadModel, MistakesOfExportersAreAccepted) {
    const std::string whole = rich().glb();
    const Model trailing = read(whole + "more");
    EXPECT_EQ(trailing.parts.size(), 3u);
    ASSERT_EQ(trailing.notes.size(), 1u);
    EXPECT_EQ(trailing.notes[0].code, "bytes-ignored");
    EXPECT_EQ(read("\xef\xbb\xbf" + rich().gltf()).parts.size(), 3u);
    // Whole numbers as 1.0, a data: URI without a media type.
    json document = json::parse(rich().gltf());
    for (json& accessor : document["accessors"])
        for (const char* name : {"bufferView", "componentType", "count"}) accessor[name] = accessor[name].get<double>();
    for (json& view : document["bufferViews"]) view["byteOffset"] = view["byteOffset"].get<double>();
    document["scene"] = 0.0;
    std::string uri = document["buffers"][0]["uri"];
    document["buffers"][0]["uri"] = uri.replace(0, uri.find(','), "data:;base64");
    EXPECT_EQ(read(document.dump()).parts.size(), 3u);
    document["scene"] = 0.5;
    EXPECT_THAT(refusal(document.dump()), HasSubstr("scene must be a whole number"));
}

/// Lists that are not drawn may contain anything.
TEST(ReadModel, UnusedPartsCannotMakeAFileInvalid) {
    GlbWriter writer = one_triangle();
    writer.document["animations"] = {{{"channels", 7}}};
    writer.document["skins"] = {{{"joints", "none"}}};
    writer.document["cameras"] = {{{"type", 3}}};
    writer.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "no such light"}}};
    writer.document["extensionsRequired"] = {"KHR_lights_punctual", "KHR_animation_pointer", "KHR_materials_variants"};
    writer.document["nodes"][0]["skin"] = 0;
    writer.document["nodes"][0]["translation"] = {100, 0, 0};
    const Model model = read(writer.glb());
    EXPECT_EQ(place(model, model.parts[0].vertices[1]), glm::vec3(1, 0, 0));
    std::vector<std::string> codes;
    for (const Note& note : model.notes) codes.push_back(note.code + " " + note.where);
    EXPECT_THAT(codes, testing::UnorderedElementsAre("extension-ignored extensions.KHR_lights_punctual",
                                                     "skin-at-rest nodes[0]", "animations-ignored animations",
                                                     "cameras-ignored cameras"));
}

/// Whatever a file contains, it is read or refused.
TEST(ReadModel, MutationsAreReadOrRefused) {
    Random random(1);
    const std::vector<std::string> good = {rich().glb(), rich().gltf(), one_triangle().glb()};
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = good[random.below(good.size())];
        const std::uint64_t changes = 1 + random.below(8);
        for (std::uint64_t change = 0; change < changes; ++change) {
            const std::size_t at = random.below(bytes.size());
            const std::uint64_t kind = random.below(4);
            if (kind == 0) {
                bytes[at] = static_cast<char>(random.below(256));
            } else if (kind == 1) {
                bytes[at] = static_cast<char>(bytes[at] ^ 1 << random.below(8));
            } else if (kind == 2) {
                bytes[at] = "0123456789-[]{},\":e"[random.below(19)];
            } else {
                bytes.erase(at, 1 + random.below(4));
                if (bytes.size() > 12 && random.below(2)) bytes.replace(8, 4, little_endian(bytes.size(), 4));
            }
        }
        refused += refusal(bytes) != "was read";
    }
    EXPECT_GT(refused, 200);
    EXPECT_LT(refused, 2000);
}

}  // namespace

}  // namespace sheer::test::read_model_test
