#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/assets/gltf_container.h"
#include "renderer/assets/gltf_object.h"
#include "renderer/notes.h"
#include "renderer/scene/assets.h"

namespace sheer {

/// Gives the bytes of another file that a model names (percent signs decoded). Throws AssetError where it may not.
using OtherFiles = std::function<std::string(const std::string& name)>;

/// For a model that stands alone: throws AssetError for every name.
std::string no_other_files(const std::string& name);

/// One of the lists at the top of a glTF file, and what one of its items is called.
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

/// The bytes of a buffer view, decompressed where need be.
struct GltfView {
    std::string_view bytes;
    std::size_t stride_bytes = 0;  ///< between elements; 0 where they are packed
};

/// A .glb or .gltf file: its objects, and its bytes when they are asked for, so that what is not drawn is not looked
/// at. Source: Khronos, glTF 2.0, sections 3.6 and 4.4. All functions throw AssetError with the reason.
class GltfFile {
  public:
    /// `bytes` and `others` outlive it. Refuses a file that needs an extension that changes what is drawn and is not
    /// read; other extensions become notes.
    GltfFile(std::string_view bytes, const OtherFiles& others);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const GltfObject& root() const { return m_root; }
    std::size_t count(const GltfList& list) const;
    /// `from` names what refers to the item, for the error if it is not there.
    GltfObject item(const GltfList& list, std::uint64_t index, const std::string& from) const;

    /// EXT_meshopt_compression is undone. The bytes stay while the file does.
    GltfView view(std::uint64_t index, const std::string& from);
    /// A part of a buffer that `object` (a buffer view or its extension) says by buffer, byteOffset and byteLength.
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
    std::map<std::uint64_t, std::string> m_buffers;  ///< that are not the binary chunk
    std::map<std::uint64_t, std::string> m_decoded;  ///< by the index of the buffer view
    std::vector<Note> m_notes;
};

}  // namespace sheer
