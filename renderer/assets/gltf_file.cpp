#include "renderer/assets/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/assets/file_bytes.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
constexpr std::size_t glb_header_bytes = 12, chunk_header_bytes = 8;
/// tinygltf goes down into extras and extensions by recursion.
constexpr int max_json_depth = 100;
/// Of each of the lists at the top: their objects take far more memory than their text.
constexpr std::size_t max_objects = 100000;
/// A picture or a buffer may stand in a .gltf as text, beside a .glb's JSON only in small.
constexpr std::size_t max_glb_json_bytes = std::size_t{64} << 20;

/// Extensions that change nothing of what is read here, or are read.
constexpr std::array known_extensions = {"KHR_materials_unlit", "KHR_mesh_quantization"};

struct Container {
    std::string_view text;
    bool binary = false;
    std::size_t chunk_bytes = 0;  ///< of the binary chunk; 0 where there is none
};

/// The header and the chunks of a .glb, which must fill the file.
Container open_glb(std::string_view bytes) {
    ByteReader reader(bytes, 4);
    const std::uint32_t version = reader.u32_little(), length = reader.u32_little();
    if (version != 2) throw AssetError(fmt::format("the file is binary glTF of version {}; only 2 is read", version));
    if (length != bytes.size())
        throw AssetError(fmt::format("the file is {}: it has {} bytes, and its header says {}",
                                     bytes.size() < length ? "cut off" : "too long", bytes.size(), length));
    Container container{{}, true, 0};
    for (int number = 0; reader.left() > 0; ++number) {
        if (reader.left() < chunk_header_bytes) throw AssetError("the file ends within the header of a chunk");
        const std::uint32_t size = reader.u32_little(), type = reader.u32_little();
        if (size > reader.left())
            throw AssetError(
                fmt::format("chunk {} of the file has {} bytes, of which {} are there", number, size, reader.left()));
        const std::string_view chunk = reader.take(size);
        if (number == 0 && type == json_chunk) container.text = chunk;
        if (number == 1 && type == binary_chunk) container.chunk_bytes = size;
    }
    if (container.text.empty()) throw AssetError("the file's first chunk is not JSON");
    if (container.text.size() > max_glb_json_bytes)
        throw AssetError(fmt::format("the file's JSON has {} bytes; at most {} are read", container.text.size(),
                                     max_glb_json_bytes));
    return container;
}

Container open_container(std::string_view bytes) {
    if (bytes.starts_with("glTF")) {
        if (bytes.size() < glb_header_bytes) throw AssetError("the file ends within its header");
        return open_glb(bytes);
    }
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || bytes[first] != '{')
        throw AssetError("the file is neither a .glb, which begins with \"glTF\", nor a .gltf, which is JSON");
    return {bytes, false, 0};
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
        // The library's text begins with the name of its exception in brackets.
        const std::string message = error.what();
        throw AssetError("the file's JSON cannot be read: " +
                         message.substr(std::min(message.find("] ") + 2, message.size())));
    }
}

/// What stands in the file under `what`, such as "buffer 3".
struct Described {
    const json& object;
    std::string what;

    std::optional<std::uint64_t> whole_number(const char* name) const {
        const auto found = object.find(name);
        if (found == object.end()) return std::nullopt;
        if (!found->is_number_unsigned())
            throw AssetError(fmt::format("{}: {} must be a whole number from 0 up", what, name));
        return found->get<std::uint64_t>();
    }

    std::uint64_t needed_number(const char* name) const {
        const auto number = whole_number(name);
        if (!number) throw AssetError(fmt::format("{}: {} is missing", what, name));
        return *number;
    }
};

class Checker {
  public:
    Checker(const json& document, const Container& container) : m_document(document), m_container(container) {}

    void check() {
        if (!m_document.is_object()) throw AssetError("the file's JSON is not an object");
        check_version();
        check_extensions();
        for (const auto& [name, value] : m_document.items())
            if (value.is_array() && value.size() > max_objects)
                throw AssetError(
                    fmt::format("the file has {} {}; at most {} are read", value.size(), name, max_objects));
        for (std::size_t i = 0; i < list("buffers").size(); ++i) check_buffer(i);
        for (std::size_t i = 0; i < list("bufferViews").size(); ++i) check_view(i);
        for (std::size_t i = 0; i < list("images").size(); ++i) check_image(i);
    }

  private:
    const json& list(const char* name) const {
        static const json none = json::array();
        const auto found = m_document.find(name);
        if (found == m_document.end()) return none;
        if (!found->is_array()) throw AssetError(fmt::format("{} is not a list", name));
        return *found;
    }

    Described item(const char* of, const char* name, std::size_t index) const {
        Described described{list(of).at(index), fmt::format("{} {}", name, index)};
        if (!described.object.is_object()) throw AssetError(described.what + " is not an object");
        return described;
    }

    void check_version() const {
        const auto asset = m_document.find("asset");
        if (asset == m_document.end() || !asset->is_object() || !asset->contains("version") ||
            !asset->at("version").is_string())
            throw AssetError("the file is JSON without the version of glTF (asset.version)");
        const auto version = asset->at("version").get<std::string>();
        if (!version.starts_with("2."))
            throw AssetError(fmt::format("the file is glTF of version {:.20}; only 2.x is read", version));
    }

    void check_extensions() const {
        for (const json& extension : list("extensionsRequired")) {
            if (!extension.is_string()) throw AssetError("extensionsRequired holds something that is not a name");
            const auto name = extension.get<std::string>();
            if (std::ranges::find(known_extensions, name) == known_extensions.end())
                throw AssetError(fmt::format("the file needs the extension {:.80}, which is not read", name));
        }
    }

    void check_buffer(std::size_t index) const {
        const Described buffer = item("buffers", "buffer", index);
        const std::uint64_t length = buffer.needed_number("byteLength");
        if (length == 0) throw AssetError(buffer.what + " is empty");
        if (buffer.object.contains("uri")) return;
        if (!m_container.binary) throw AssetError(buffer.what + " is missing: it has no uri");
        if (index != 0) throw AssetError(buffer.what + " is missing: only the first may stand in the binary chunk");
        if (m_container.chunk_bytes == 0) throw AssetError(buffer.what + " is missing: the file has no binary chunk");
        if (length > m_container.chunk_bytes)
            throw AssetError(fmt::format("{} has {} bytes, of which the binary chunk holds {}", buffer.what, length,
                                         m_container.chunk_bytes));
    }

    void check_view(std::size_t index) const {
        const Described view = item("bufferViews", "buffer view", index);
        const std::uint64_t buffer = view.needed_number("buffer"), length = view.needed_number("byteLength"),
                            offset = view.whole_number("byteOffset").value_or(0);
        if (buffer >= list("buffers").size())
            throw AssetError(fmt::format("{}: there is no buffer {}", view.what, buffer));
        const std::uint64_t whole = item("buffers", "buffer", buffer).needed_number("byteLength");
        if (length == 0) throw AssetError(view.what + " is empty");
        if (offset > whole || length > whole - offset)
            throw AssetError(fmt::format("{} reaches beyond the {} bytes of its buffer", view.what, whole));
    }

    void check_image(std::size_t index) const {
        const Described image = item("images", "image", index);
        if (const auto view = image.whole_number("bufferView"); view && *view >= list("bufferViews").size())
            throw AssetError(fmt::format("{}: there is no buffer view {}", image.what, *view));
    }

    const json& m_document;
    const Container& m_container;
};

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

tinygltf::FsCallbacks callbacks(const OtherFiles& others) {
    tinygltf::FsCallbacks files{};
    files.FileExists = [](const std::string&, void*) { return true; };
    files.ExpandFilePath = [](const std::string& name, void*) { return name; };
    files.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
        const std::string bytes = (*static_cast<const OtherFiles*>(user))(name);
        out->assign(bytes.begin(), bytes.end());
        return true;
    };
    files.user_data = const_cast<OtherFiles*>(&others);
    return files;
}

std::string percent_decoded(const std::string& text) {
    const auto digit = [](char c) {
        const std::size_t value = std::string_view("0123456789abcdefABCDEF").find(c);
        return value == std::string_view::npos ? -1 : static_cast<int>(value < 16 ? value : value - 6);
    };
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
        decoded += escape ? static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return decoded;
}

}  // namespace

std::string no_other_files(const std::string& name) {
    throw AssetError(fmt::format("the file needs another file, \"{:.80}\"; all must be inside the one", name));
}

tinygltf::Model read_gltf_file(std::string_view bytes, const OtherFiles& others) {
    if (bytes.size() > max_asset_file_bytes)
        throw AssetError(fmt::format("the file has {} bytes; at most {} are read", bytes.size(), max_asset_file_bytes));
    const Container container = open_container(bytes);
    Checker(parse_json(container.text), container).check();

    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks(callbacks(others));
    tinygltf::Model model;
    std::string errors, warnings;
    const auto length = static_cast<unsigned>(bytes.size());
    bool good = false;
    try {
        good = container.binary
                   ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()), length)
                   : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), length, "");
    } catch (const json::exception&) {
        throw AssetError("the file's JSON does not describe a model");
    }
    if (!good || !errors.empty())
        throw AssetError("the file cannot be read: " + (errors.empty() ? "it is not glTF" : first_line(errors)));
    return model;
}

std::string read_gltf_picture(const tinygltf::Model& gltf, const tinygltf::Image& image, const OtherFiles& others) {
    if (image.bufferView >= 0) {
        const tinygltf::BufferView& view = gltf.bufferViews.at(static_cast<std::size_t>(image.bufferView));
        const std::vector<unsigned char>& data = gltf.buffers.at(static_cast<std::size_t>(view.buffer)).data;
        return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
    }
    if (!image.image.empty()) return {image.image.begin(), image.image.end()};
    return others(percent_decoded(image.uri));
}

}  // namespace sheer
