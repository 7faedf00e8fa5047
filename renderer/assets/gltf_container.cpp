#include "renderer/assets/gltf_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "renderer/assets/file_bytes.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t longest_reason = 200;

constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
constexpr std::size_t glb_header_bytes = 12, chunk_header_bytes = 8;
/// The parser frees what it has read recursively.
constexpr int max_json_depth = 100;
/// In each of the top-level lists: their objects take far more memory than their text.
constexpr std::size_t max_objects = 100000;
/// A .gltf may contain pictures and buffers as text; the JSON of a .glb should have only small ones.
constexpr std::size_t max_glb_json_bytes = std::size_t{64} << 20;

/// Returns the text of the JSON chunk.
std::string_view open_glb(std::string_view bytes, GltfContainer& container) {
    ByteReader header(bytes, 4);
    const std::uint32_t version = header.u32_little(), length = header.u32_little();
    if (version != 2) throw AssetError(fmt::format("the file is binary glTF of version {}; only 2 is read", version));
    if (length > bytes.size())
        throw AssetError(
            fmt::format("the file is cut off: it has {} bytes, but its header says {}", bytes.size(), length));
    if (length < glb_header_bytes) throw AssetError(fmt::format("the file's header says that it has {} bytes", length));
    container.is_binary = true;
    container.bytes_after_end = bytes.size() - length;
    ByteReader reader(bytes.substr(0, length), glb_header_bytes);
    std::string_view text;
    for (int number = 0; reader.left() > 0; ++number) {
        if (reader.left() < chunk_header_bytes) throw AssetError("the file ends within the header of a chunk");
        const std::uint32_t size = reader.u32_little(), type = reader.u32_little();
        if (size > reader.left())
            throw AssetError(
                fmt::format("chunk {} of the file has {} bytes, but only {} are left", number, size, reader.left()));
        const std::string_view chunk = reader.take(size);
        if (number == 0 && type == json_chunk) text = chunk;
        if (number == 1 && type == binary_chunk) container.binary = chunk;
    }
    if (text.empty()) throw AssetError("the file's first chunk is not JSON");
    if (text.size() > max_glb_json_bytes)
        throw AssetError(
            fmt::format("the file's JSON has {} bytes; at most {} are read", text.size(), max_glb_json_bytes));
    return text;
}

std::string_view without_byte_order_mark(std::string_view text) {
    return text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
}

std::string_view find_json(std::string_view bytes, GltfContainer& container) {
    if (bytes.starts_with("glTF")) {
        if (bytes.size() < glb_header_bytes) throw AssetError("the file ends within its header");
        return without_byte_order_mark(open_glb(bytes, container));
    }
    const std::string_view text = without_byte_order_mark(bytes);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || text[first] != '{')
        throw AssetError("the file is neither a .glb, which begins with \"glTF\", nor a .gltf, which is JSON");
    return text;
}

void check_depth(std::string_view text) {
    int depth = 0;
    bool in_text = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_text && c == '\\') {
            ++i;
        } else if (c == '"') {
            in_text = !in_text;
        } else if (!in_text && (c == '{' || c == '[')) {
            if (++depth > max_json_depth)
                throw AssetError(fmt::format("the file's JSON is nested more than {} deep", max_json_depth));
        } else if (!in_text && (c == '}' || c == ']')) {
            --depth;
        }
    }
}

json parse_json(std::string_view text) {
    check_depth(text);
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        // The library's message begins with the name of the exception in brackets, and ends with bytes of the file.
        const std::string_view message = error.what();
        throw AssetError("the file's JSON cannot be read: " +
                         printable(message.substr(std::min(message.find("] ") + 2, message.size())), longest_reason));
    }
}

void check_version(const json& document) {
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version") ||
        !asset->at("version").is_string())
        throw AssetError("the file is JSON without the version of glTF (asset.version)");
    const auto version = asset->at("version").get<std::string>();
    if (!version.starts_with("2."))
        throw AssetError(fmt::format("the file is glTF of version {:.20}; only 2.x is read", version));
}

}  // namespace

GltfContainer open_gltf(std::string_view bytes) {
    if (bytes.size() > max_asset_file_bytes)
        throw AssetError(fmt::format("the file has {} bytes; at most {} are read", bytes.size(), max_asset_file_bytes));
    GltfContainer container;
    container.document = parse_json(find_json(bytes, container));
    if (!container.document.is_object()) throw AssetError("the file's JSON is not an object");
    check_version(container.document);
    for (const auto& [name, value] : container.document.items())
        if (value.is_array() && value.size() > max_objects)
            throw AssetError(fmt::format("the file has {} {}; at most {} are read", value.size(), name, max_objects));
    return container;
}

}  // namespace sheer
