#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sheer::test {

/// `value` in `count` bytes, least significant first.
inline std::string little_endian(std::uint64_t value, int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
    return bytes;
}

inline std::string big_endian(std::uint32_t value) {
    const std::string bytes = little_endian(value, 4);
    return {bytes.rbegin(), bytes.rend()};
}

/// A PNG of 8-bit RGBA, with its pixels in stored (not compressed) blocks: ISO 15948, RFC 1950 and RFC 1951.
inline std::string make_png(int width_px, int height_px, const std::vector<std::uint8_t>& rgba) {
    const auto chunk = [](const std::string& type, const std::string& data) {
        std::uint32_t crc = 0xffffffffu;
        for (const char c : type + data) {
            crc ^= static_cast<std::uint8_t>(c);
            for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
        return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(~crc);
    };
    std::string rows;
    for (int y = 0; y < height_px; ++y) {
        rows += '\0';  // no filter
        rows.append(reinterpret_cast<const char*>(rgba.data()) + std::size_t(y) * width_px * 4,
                    std::size_t(width_px) * 4);
    }
    std::string zlib = "\x78\x01";
    std::uint32_t a = 1, b = 0;
    for (const char c : rows) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    for (std::size_t at = 0; at < rows.size(); at += 65535) {
        const std::string block = rows.substr(at, 65535);
        zlib += at + 65535 >= rows.size() ? '\1' : '\0';
        zlib += little_endian(block.size(), 2) + little_endian(~block.size(), 2) + block;
    }
    zlib += big_endian(b << 16 | a);
    const std::string header = big_endian(static_cast<std::uint32_t>(width_px)) +
                               big_endian(static_cast<std::uint32_t>(height_px)) + std::string("\x08\x06\0\0\0", 5);
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", zlib) + chunk("IEND", "");
}

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t j = 0; j < 3; ++j)
            three = three << 8 | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j) text += i + j > bytes.size() ? '=' : digits[three >> (18 - 6 * j) & 63];
    }
    return text;
}

/// Builds a glTF file piece by piece. Each function returns the index of the added object.
class GlbWriter {
  public:
    nlohmann::json document = {
        {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
    std::string binary;
    std::vector<nlohmann::json> other_buffers;  ///< of a .glb, from buffer 1 on

    int add(const char* list, nlohmann::json object) {
        document[list].push_back(std::move(object));
        return static_cast<int>(document[list].size()) - 1;
    }

    int view(const std::string& bytes) {
        binary.resize((binary.size() + 3) / 4 * 4);
        const std::size_t offset = binary.size();
        binary += bytes;
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
    }

    /// `values` of one element after another; `type` is SCALAR, VEC2, VEC3 or VEC4.
    template <typename T>
    int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
        std::string bytes(values.size() * sizeof(T), '\0');
        std::memcpy(bytes.data(), values.data(), bytes.size());
        const int components = type == "SCALAR" ? 1 : type.back() - '0';
        nlohmann::json object = {{"bufferView", view(bytes)},
                                 {"componentType", component_type(T{})},
                                 {"count", values.size() / static_cast<std::size_t>(components)},
                                 {"type", type}};
        if (normalized) object["normalized"] = true;
        return add("accessors", object);
    }

    /// A texture with its own embedded picture.
    int texture(const std::string& png) {
        const int image = add("images", {{"bufferView", view(png)}, {"mimeType", "image/png"}});
        return add("textures", {{"source", image}});
    }

    int material(const std::string& alpha_mode, const std::array<double, 4>& factor, int base_texture = -1) {
        nlohmann::json pbr = {{"baseColorFactor", factor}};
        if (base_texture >= 0) pbr["baseColorTexture"]["index"] = base_texture;
        return add("materials", {{"alphaMode", alpha_mode}, {"pbrMetallicRoughness", pbr}});
    }

    /// A mesh of one primitive with these accessors.
    int mesh(const nlohmann::json& attributes, int indices, int material) {
        nlohmann::json primitive = {{"attributes", attributes}};
        if (indices >= 0) primitive["indices"] = indices;
        if (material >= 0) primitive["material"] = material;
        return add("meshes", {{"primitives", {primitive}}});
    }

    /// A node of the scene.
    int root(nlohmann::json node) {
        const int index = add("nodes", std::move(node));
        document["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    std::string glb() const {
        std::string data = binary;
        data.resize((data.size() + 3) / 4 * 4);
        nlohmann::json whole = document;
        if (!data.empty()) {
            whole["buffers"] = {{{"byteLength", data.size()}}};
            for (const nlohmann::json& other : other_buffers) whole["buffers"].push_back(other);
        }
        return wrap(whole.dump(), data);
    }

    /// The same as a .gltf, with the buffer as text.
    std::string gltf() const {
        nlohmann::json whole = document;
        whole["buffers"] = {
            {{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}};
        return whole.dump();
    }

    /// A .glb of this JSON and binary chunk (none if empty).
    static std::string wrap(std::string json, const std::string& data) {
        json.resize((json.size() + 3) / 4 * 4, ' ');
        std::string chunks = little_endian(json.size(), 4) + "JSON" + json;
        if (!data.empty()) chunks += little_endian(data.size(), 4) + std::string("BIN\0", 4) + data;
        return "glTF" + little_endian(2, 4) + little_endian(12 + chunks.size(), 4) + chunks;
    }

  private:
    static int component_type(float) { return 5126; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint32_t) { return 5125; }
};

}  // namespace sheer::test
