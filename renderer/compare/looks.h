#pragma once
#include <memory>
#include <vector>

#include "renderer/compare/workbench.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// The scene in one look: its own, or the shading and texture that a method brings.
struct Look {
    nlohmann::json changes;  ///< MethodSpec::look
    std::unique_ptr<Scene> scene;
    /// Has the reference in this look. Of the scene's own look it is the comparison's run, otherwise one that has
    /// nothing else.
    const Run* run = nullptr;
    std::unique_ptr<Run> own_run;
    Backdrops reference_over;  ///< the reference over other backgrounds
};

/// The scene in each look that the methods of a spec ask for. The geometry is the same in all of them.
class Looks {
  public:
    /// `geometry` has the textures of all looks. All references must outlive it. Throws SpecError as check_loops does.
    Looks(const Spec& spec, const gl::Functions& gl, const Geometry& geometry);

    Scene& own_scene() { return *m_all.front().scene; }
    const Scene& own_scene() const { return *m_all.front().scene; }
    const Look& of(const MethodSpec& method) const;
    /// A method is compared with the exact picture of what it draws, so each look has a reference; `run` gets that of
    /// the scene's own look. See render_reference().
    void render_references(const Spec& spec, Workbench& bench, Run& run);

  private:
    std::vector<Look> m_all;  ///< first the scene's own
};

/// What the files of the scene and of every look give, for the Looks of a spec.
Geometry build_geometry_of_looks(const Spec& spec, AssetReader& assets);
/// Those files that `assets` has read for the scene and the looks.
std::vector<SourceFile> source_files_of(const Spec& spec, const AssetReader& assets);

}  // namespace sheer
