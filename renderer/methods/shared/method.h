#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/gl/context.h"
#include "renderer/gl/timer.h"
#include "renderer/params/param_table.h"
#include "renderer/passes/pass.h"
#include "renderer/passes/pixel_trace.h"
#include "renderer/passes/target.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// What a method is made for. All references outlive the method.
struct MethodSetup {
    const gl::Context& context;
    const gl::Functions& gl;  ///< the context's, unless a test counts calls
    const Scene& scene;
    const Target& target;
};

/// A transparency method, ready to render one scene into one target again and again.
class Method {
  public:
    virtual ~Method() = default;
    /// Renders a whole frame, including opaque geometry, into the target. GL state is set by a Pass, which restores it.
    virtual void render(gl::FrameTimer& timer) = 0;
    /// Forgets earlier frames: the next one is drawn like the first of a new method.
    virtual void restart() {}
    /// Whether a frame depends on earlier ones. restart() then forgets them.
    virtual bool keeps_frames() const { return false; }
    /// The noise of the next frame is that of frame `number` of an animation; 0 is that of a single picture. For
    /// methods whose noise is the same in all frames, or that have none, there is nothing to do.
    virtual void take_noise_of(int /*number*/) {}
    /// Textures and buffers that the method needs beside the target.
    virtual std::int64_t memory_bytes() const { return 0; }
    /// An object with what only this method reports; may render frames of its own, which are not timed.
    virtual nlohmann::json findings(gl::FrameTimer&) { return nlohmann::json::object(); }
    /// What the pixel of `trace` is made of in the method's own terms, after a frame that was traced. It is read from
    /// the trace of the method's programs and from its textures.
    virtual std::vector<PixelFact> explain(const PixelTrace&) const { return {}; }
};

/// A method that begins with the opaque pass and goes on in the same target.
class OpaqueFirst : public Method {
  protected:
    explicit OpaqueFirst(const MethodSetup& setup)
        : m_gl(setup.gl), m_scene(setup.scene), m_target(setup.target), m_opaque(setup.gl, setup.scene, setup.target) {}

    /// A pass on the target, or on a framebuffer of its size.
    [[nodiscard]] Pass begin() const { return {m_gl, m_target}; }
    [[nodiscard]] Pass begin(const gl::Framebuffer& framebuffer) const {
        return {m_gl, framebuffer, m_target.width_px(), m_target.height_px()};
    }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    OpaquePass m_opaque;
};

/// A method describes itself; the file renderer/methods/<id>.cpp ends with `MethodInfo method_<id>()`, which fills in
/// all but the last four and hands it to describe_method().
struct MethodInfo {
    std::string id;
    std::string name;
    std::string kind;  ///< e.g. "sorted blending", "reference"
    std::string summary;
    std::string paper;  ///< its source
    std::string good_at;
    std::string bad_at;
    std::string memory;         ///< per pixel, beside the target
    std::string passes;         ///< how often it draws the transparent geometry, and full-screen passes
    std::string needs;          ///< of the device, beside blending and a depth test; "" if nothing
    bool needs_sorting = true;  ///< false if the order does not matter or is that of submission
    /// The parameter that is the least transmittance with which a pixel still needs fragments; "" if every fragment is
    /// needed.
    std::string saturation_parameter;
    std::string no_metrics_reason;  ///< set if the picture is not meant to be correct and so has no error metrics

    std::vector<Param> parameters;
    /// `parameters_here` are normalised. Throws Unsupported if the device lacks something.
    std::function<std::unique_ptr<Method>(const MethodSetup&, const nlohmann::json& parameters_here)> make;
    /// Whether it draws in depth order, if that depends on the scene and the parameters; otherwise null.
    std::function<bool(const Scene& scene, const nlohmann::json& parameters_here)> sorts_here;
    /// Method::memory_bytes() per pixel of a target whose pixels have 4, 8 or 16 bytes, but for what a scene with
    /// opaque geometry needs more; none if it depends on the scene or the device.
    std::function<std::optional<double>(const nlohmann::json& parameters_here, int pixel_bytes)> bytes_per_px;

    bool sorts(const Scene& scene, const nlohmann::json& parameters_here) const {
        return sorts_here ? sorts_here(scene, parameters_here) : needs_sorting;
    }
    /// Null if the method has none.
    const Param* saturation() const;
    /// The value of saturation_parameter; none if there is no such parameter.
    std::optional<double> saturation_of(const nlohmann::json& parameters_here) const;
};

/// For methods without parameters.
struct NoParameters {
    static ParamTable<NoParameters> table() { return {}; }
};

template <typename Parameters>
using MakeFunction = std::function<std::unique_ptr<Method>(const MethodSetup&, const Parameters&)>;
template <typename Parameters>
using BytesFunction = std::function<std::optional<double>(const Parameters&, int pixel_bytes)>;
template <typename Parameters>
using SortsFunction = std::function<bool(const Scene&, const Parameters&)>;

/// Adds to `info` what follows from its parameters: their descriptions, and a factory that reads them first.
template <typename Parameters>
MethodInfo describe_method(MethodInfo info, const ParamTable<Parameters>& table,
                           const std::type_identity_t<MakeFunction<Parameters>>& make,
                           const std::type_identity_t<BytesFunction<Parameters>>& bytes_per_px,
                           const std::type_identity_t<SortsFunction<Parameters>>& sorts = nullptr) {
    info.parameters = table.params();
    info.make = [table, make](const MethodSetup& setup, const nlohmann::json& parameters) {
        return make(setup, table.read(parameters));
    };
    info.bytes_per_px = [table, bytes_per_px](const nlohmann::json& parameters, int pixel_bytes) {
        return bytes_per_px(table.read(parameters), pixel_bytes);
    };
    if (sorts)
        info.sorts_here = [table, sorts](const Scene& scene, const nlohmann::json& parameters) {
            return sorts(scene, table.read(parameters));
        };
    return info;
}

/// For describe_method(): `T` has a constructor that takes a MethodSetup and the parameters.
template <typename T>
inline constexpr auto make_new = [](const MethodSetup& setup, const auto& parameters) -> std::unique_ptr<Method> {
    return std::make_unique<T>(setup, parameters);
};

/// For describe_method(): the memory is that of `pixels` pixels of the target, and of so many bytes.
inline auto pixels_and_bytes(double pixels, double bytes = 0) {
    return [=](const auto&, int pixel_bytes) { return std::optional(pixels * pixel_bytes + bytes); };
}
/// For describe_method(): the memory depends on the scene.
inline constexpr auto bytes_by_scene = [](const auto&, int) -> std::optional<double> { return std::nullopt; };

/// Every method, from the generated table.
const std::vector<MethodInfo>& all_methods();
/// Null if there is none with this id, which is case-insensitive.
const MethodInfo* find_method(const std::string& id);

}  // namespace sheer
