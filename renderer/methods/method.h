#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/frame/pixel_trace.h"
#include "renderer/frame/target.h"
#include "renderer/gl/context.h"
#include "renderer/gl/timer.h"
#include "renderer/scene/scene.h"
#include "renderer/spec/param.h"

namespace sheer {

/// What a method is made for. All references outlive the method.
struct MethodSetup {
    const gl::Context& context;
    const gl::Functions& gl;  ///< the context's, unless a test counts calls
    const Scene& scene;
    const Target& target;
    const nlohmann::json& parameters;  ///< normalised: every parameter is there
};

/// A transparency method, ready to render one scene into one target again and again.
class Method {
  public:
    virtual ~Method() = default;
    /// Renders a whole frame, opaque geometry included, into the target. Each pass sets the GL state it needs.
    virtual void render(gl::FrameTimer& timer) = 0;
    /// Forgets the frames before: the next one is drawn as a new method's first.
    virtual void restart() {}
    /// Whether a frame is made of the ones before it. Then restart() forgets them.
    virtual bool keeps_frames() const { return false; }
    /// Textures and buffers that the method needs beside the target.
    virtual std::int64_t memory_bytes() const { return 0; }
    /// What only this method has to report, an object; may render frames of its own, which are not timed.
    virtual nlohmann::json findings(gl::FrameTimer&) { return nlohmann::json::object(); }
    /// What the pixel of `trace` is made of in the method's own terms, after a frame that was traced; from what the
    /// trace tells of its programs and from its own textures.
    virtual std::vector<PixelFact> explain(const PixelTrace&) const { return {}; }
};

/// A method describes itself; the file renderer/methods/<id>.cpp ends with `MethodInfo method_<id>()`.
struct MethodInfo {
    std::string id;
    std::string name;
    std::string kind;  ///< e.g. "sorted blending", "reference"
    std::string summary;
    std::string paper;  ///< where it comes from
    std::string good_at;
    std::string bad_at;
    std::string memory;         ///< per pixel, beside the target
    bool needs_sorting = true;  ///< false where the order of submission does not matter or is what is drawn
    /// Where that depends on the scene and the parameters: whether it draws in an order of depths; null elsewhere.
    std::function<bool(const Scene& scene, const nlohmann::json& parameters)> sorts_here;
    std::vector<Param> parameters;
    std::string no_metrics_reason;  ///< set where the picture is not meant to be right, so has no error metrics
    /// Throws Unsupported if the device lacks something.
    std::function<std::unique_ptr<Method>(const MethodSetup&)> make;

    bool sorts(const Scene& scene, const nlohmann::json& parameters_here) const {
        return sorts_here ? sorts_here(scene, parameters_here) : needs_sorting;
    }
};

/// Every method, from the generated table.
const std::vector<MethodInfo>& all_methods();
/// Null if there is none of this id; letter case is passed over.
const MethodInfo* find_method(const std::string& id);

}  // namespace sheer
