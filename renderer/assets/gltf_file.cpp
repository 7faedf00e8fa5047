#include "renderer/assets/gltf_file.h"

#include <fmt/format.h>

#include "renderer/assets/gltf_extensions.h"
#include "renderer/assets/gltf_meshopt.h"
#include "renderer/assets/gltf_uri.h"

namespace sheer {

using nlohmann::json;

std::string no_other_files(const std::string& name) {
    throw AssetError(fmt::format("the file needs another file, \"{:.80}\"; everything must be in one file", name));
}

GltfFile::GltfFile(std::string_view bytes, const OtherFiles& others)
    : m_container(open_gltf(bytes)), m_root(m_container.document, "the file", ""), m_others(others) {
    if (m_container.bytes_after_end > 0)
        note("bytes-ignored",
             fmt::format("The file has {} bytes after the length in its header; they are ignored.",
                         m_container.bytes_after_end),
             "");
    check_extensions();
}

void GltfFile::check_extensions() {
    static const json none = json::array();
    const auto required = m_container.document.find("extensionsRequired");
    for (const json& extension : required == m_container.document.end() ? none : *required) {
        if (!extension.is_string()) throw AssetError("extensionsRequired holds something that is not a name");
        const auto name = extension.get<std::string>();
        if (!is_extension_read(name) && !is_extension_beside_the_picture(name))
            throw AssetError(fmt::format("the file needs the extension {:.80}, which is not supported", name));
    }
    for (const auto& [name, where] : unread_extensions(m_container.document))
        note("extension-ignored", fmt::format("The extension {:.80} is not supported and is ignored.", name), where);
}

const json& GltfFile::list(const GltfList& list) const {
    static const json none = json::array();
    const auto found = m_container.document.find(list.name);
    if (found == m_container.document.end()) return none;
    if (!found->is_array()) throw AssetError(fmt::format("{} is not a list", list.name));
    return *found;
}

std::size_t GltfFile::count(const GltfList& of) const {
    return list(of).size();
}

GltfObject GltfFile::item(const GltfList& of, std::uint64_t index, const std::string& from) const {
    const json& all = list(of);
    if (index >= all.size()) throw AssetError(fmt::format("{}: there is no {} {}", from, of.one, index));
    return {all[index], fmt::format("{} {}", of.one, index), fmt::format("{}[{}]", of.name, index)};
}

std::string GltfFile::bytes_of(const GltfObject& object, const std::string& uri) const {
    try {
        if (auto data = decode_data_uri(uri)) return std::move(*data);
    } catch (const AssetError& error) {
        object.fail(error.what());
    }
    return m_others(percent_decoded(uri));
}

std::string_view GltfFile::buffer(std::uint64_t index, const std::string& from) {
    const GltfObject object = item(gltf_lists::buffers, index, from);
    const std::uint64_t length = object.needed_number("byteLength");
    std::string_view bytes;
    if (object.has("uri")) {
        const auto [known, added] = m_buffers.try_emplace(index);
        if (added) known->second = bytes_of(object, object.text("uri"));
        bytes = known->second;
    } else {
        if (!m_container.is_binary) throw AssetError(object.what() + " is missing: it has no uri");
        if (index != 0) throw AssetError(object.what() + " is missing: only the first may be in the binary chunk");
        if (!m_container.binary) throw AssetError(object.what() + " is missing: the file has no binary chunk");
        bytes = *m_container.binary;
    }
    if (length > bytes.size())
        throw AssetError(fmt::format("{} has {} bytes, but only {} exist", object.what(), length, bytes.size()));
    return bytes.substr(0, length);
}

std::string_view GltfFile::span(const GltfObject& object) {
    const std::string_view whole = buffer(object.needed_number("buffer"), object.what());
    const std::uint64_t offset = object.whole_number("byteOffset").value_or(0),
                        length = object.needed_number("byteLength");
    if (length == 0) throw AssetError(object.what() + " is empty");
    if (offset > whole.size() || length > whole.size() - offset)
        throw AssetError(fmt::format("{} exceeds the {} bytes of its buffer", object.what(), whole.size()));
    return whole.substr(offset, length);
}

GltfView GltfFile::view(std::uint64_t index, const std::string& from) {
    const GltfObject object = item(gltf_lists::buffer_views, index, from);
    const auto compressed = object.extension("EXT_meshopt_compression");
    const std::size_t stride = object.whole_number("byteStride").value_or(0);
    if (!compressed) return {span(object), stride};
    const auto [known, added] = m_decoded.try_emplace(index);
    if (added) known->second = decode_meshopt(*compressed, span(*compressed));
    return {known->second, stride};
}

std::string GltfFile::picture(const GltfObject& image) {
    if (const auto index = image.whole_number("bufferView")) return std::string(view(*index, image.what()).bytes);
    if (!image.has("uri")) throw AssetError("it has neither a uri nor a buffer view");
    return bytes_of(image, image.text("uri"));
}

void GltfFile::note(const std::string& code, const std::string& text, const std::string& where) {
    add_note(m_notes, {code, text, where});
}

}  // namespace sheer
