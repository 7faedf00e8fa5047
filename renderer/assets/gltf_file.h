#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/assets/gltf_container.h"
#include "renderer/assets/gltf_object.h"
#include "renderer/core/notes.h"
#include "renderer/scene/assets.h"

namespace sheer {

/// Returns the bytes of another file that a model names (percent-decoded). Throws AssetError if it must not be read.
using OtherFiles = std::function<std::string(const std::string& name)>;

/// For a model that must be self-contained: throws AssetError for every name.
std::string no_other_files(const std::string& name);

/// One of the top-level lists of a glTF file, and the name of one of its items.
struct GltfList {
    const char* name;
    const char* one;
};
namespace gltf_lists {
inline constexpr GltfList accessors{"accessors", "accessor"}, buffers{"buffers", "buffer"},
    buffer_views{"bufferViews", "buffer view"}, images{"images", "image"}, materials{"materials", "material"},
    meshes{"meshes", "mesh"}, nodes{"nodes", "node"}, samplers{"samplers", "sampler"}, scenes{"scenes", "scene"},
    textures{"textures", "texture"};
}

/// The bytes of a buffer view, decompressed if necessary.
struct GltfView {
    std::string_view bytes;
    std::size_t stride_bytes = 0;  ///< between elements; 0 if they are packed
};

/// A .glb or .gltf file: its objects, and its bytes when they are requested, so that what is not drawn is not checked.
/// Source: Khronos, glTF 2.0, sections 3.6 and 4.4. All functions throw AssetError with the reason.
class GltfFile {
  public:
    /// `bytes` and `others` outlive it. Refuses a file that requires an unsupported extension that changes what is
    /// drawn; other extensions become notes.
    GltfFile(std::string_view bytes, const OtherFiles& others);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const GltfObject& root() const { return m_root; }
    std::size_t count(const GltfList& list) const;
    /// `from` names what refers to the item, for the error if it does not exist.
    GltfObject item(const GltfList& list, std::uint64_t index, const std::string& from) const;

    /// EXT_meshopt_compression is decoded. The bytes live as long as the file.
    GltfView view(std::uint64_t index, const std::string& from);
    /// The part of a buffer that `object` (a buffer view or its extension) gives as buffer, byteOffset and byteLength.
    std::string_view span(const GltfObject& object);
    /// The encoded picture of an image.
    std::string picture(const GltfObject& image);

    void note(const std::string& code, const std::string& text, const std::string& where);
    const std::vector<Note>& notes() const { return m_notes; }

  private:
    const nlohmann::json& list(const GltfList& list) const;
    std::string_view buffer(std::uint64_t index, const std::string& from);
    std::string bytes_of(const GltfObject& object, const std::string& uri) const;
    void check_extensions();

    GltfContainer m_container;
    GltfObject m_root;
    const OtherFiles& m_others;
    std::map<std::uint64_t, std::string> m_buffers;  ///< other than the binary chunk
    std::map<std::uint64_t, std::string> m_decoded;  ///< by the index of the buffer view
    std::vector<Note> m_notes;
};

}  // namespace sheer
