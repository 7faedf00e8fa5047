#include "renderer/compare/looks.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "renderer/compare/reference.h"
#include "renderer/counting/loop_check.h"

namespace sheer {

Looks::Looks(const Spec& spec, const gl::Functions& gl, const Geometry& geometry) {
    const auto add = [&](const nlohmann::json& changes, const std::string& pointer) {
        nlohmann::json parameters = spec.scene;
        parameters.update(changes);
        Look look{.changes = changes, .scene = std::make_unique<Scene>(gl, geometry, parameters, pointer)};
        check_loops(gl, *look.scene, spec.image);
        m_all.push_back(std::move(look));
    };
    add(nlohmann::json::object(), "/scene");
    for (const MethodSpec& method : spec.methods)
        if (std::ranges::find(m_all, method.look, &Look::changes) == m_all.end()) add(method.look, method.pointer);
}

const Look& Looks::of(const MethodSpec& method) const {
    const auto found = std::ranges::find(m_all, method.look, &Look::changes);
    if (found == m_all.end()) throw std::logic_error("a method has a look that its spec does not");
    return *found;
}

void Looks::render_references(const Spec& spec, Workbench& bench, Run& run) {
    for (Look& look : m_all) {
        const bool is_own = look.changes.empty();
        if (!is_own) look.own_run = std::make_unique<Run>();
        look.run = is_own ? &run : look.own_run.get();
        look.reference_over = render_reference(spec, *look.scene, bench, is_own ? run : *look.own_run);
    }
}

Geometry build_geometry_of_looks(const Spec& spec, AssetReader& assets) {
    Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    for (const MethodSpec& method : spec.methods)
        add_textures(*find_scene(spec.scene_type), method.look, method.pointer, assets, geometry);
    return geometry;
}

std::vector<SourceFile> source_files_of(const Spec& spec, const AssetReader& assets) {
    std::vector<AssetReference> references = scene_assets(spec.scene);
    for (const MethodSpec& method : spec.methods)
        std::ranges::move(look_assets(*find_scene(spec.scene_type), method.look, method.pointer),
                          std::back_inserter(references));
    return source_files(references, assets);
}

}  // namespace sheer
