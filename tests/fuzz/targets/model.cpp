#include "renderer/assets/read_model.h"
#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// glTF, as text or binary: a model that is not refused has whole triangles of vertices that exist.
void read_gltf(std::string_view input) {
    read_or_refuse<AssetError>([&] {
        const Model model = read_model(input, no_other_files);
        std::size_t indices = 0, vertices = 0;
        for (const ModelPart& part : model.parts) {
            require(part.material < model.materials.size(), "a material that does not exist");
            for (const std::uint32_t index : part.indices)
                require(index < part.vertices.size(), "a vertex that does not exist");
            require(part.indices.size() % 3 == 0, "a part of a triangle");
            indices += part.indices.size();
            vertices += part.vertices.size();
        }
        require(indices > 0 && indices <= 3 * max_model_triangles && vertices <= max_model_vertices, "over a limit");
    });
}

}  // namespace

FuzzTarget fuzz_model() {
    return {"model", read_gltf};
}

}  // namespace sheer::test
