#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "renderer/methods/shared/method.h"
#include "renderer/spec/spec.h"

namespace sheer::test {

/// The three kinds of context. GLFW needs a display, which the runner provides (Xvfb).
std::vector<std::string> contexts();

inline std::unique_ptr<gl::Context> make_context(const std::string& kind) {
    gl::ContextRequest request;
    request.context = kind;
    return gl::create_context(request);
}

/// How many primitives f2bd draws between barriers if its picture is to be exact: on llvmpipe a fragment sees all that
/// were drawn before, on a GPU only those of earlier batches.
inline int exact_batch(const gl::Context& context) {
    return context.device().software ? 0 : 1;
}

/// A scene and a target on a context, to run methods in.
class Stage {
  public:
    Stage(gl::Context& context, const Spec& spec, PixelFormat format)
        : Stage(context, spec, format, std::make_unique<NoAssets>()) {}
    Stage(gl::Context& context, const Spec& spec, PixelFormat format, std::unique_ptr<AssetReader> assets)
        : m_context(context),
          m_timer(context),
          m_scene(context.gl(), build_geometry(spec.scene, spec.image, *assets), spec.scene),
          m_target(context.gl(), spec.image, format) {}

    /// With geometry other than the spec's.
    Stage(gl::Context& context, const Spec& spec, PixelFormat format, const Geometry& geometry)
        : m_context(context),
          m_timer(context),
          m_scene(context.gl(), geometry, spec.scene),
          m_target(context.gl(), spec.image, format) {}

    const Scene& scene() const { return m_scene; }
    const Target& target() const { return m_target; }

    /// `functions` may replace the context's own, to count calls.
    std::unique_ptr<Method> make(const MethodSpec& method, const gl::Functions* functions = nullptr) {
        return find_method(method.id)->make({m_context, functions ? *functions : m_context.gl(), m_scene, m_target},
                                            method.parameters);
    }

    gl::FrameSample frame(Method& method, bool timed = false) {
        gl::FrameTimer::Frame frame = m_timer.frame(timed);
        method.render(m_timer);
        return frame.end();
    }

    Image picture(const MethodSpec& spec) {
        const auto method = make(spec);
        frame(*method);
        Image image = m_target.read();
        m_context.check("rendering " + spec.id);
        return image;
    }

  private:
    gl::Context& m_context;
    gl::FrameTimer m_timer;
    Scene m_scene;
    Target m_target;
};

/// A spec with these methods, each an id or an object.
inline Spec make_spec(const nlohmann::json& scene, const nlohmann::json& methods, int size_px = 32,
                      const std::string& format = "rgba8") {
    return parse_spec(
        {{"scene", scene},
         {"methods", methods},
         {"image", {{"width", size_px}, {"height", size_px}, {"background", {0.2, 0.4, 0.6}}, {"format", format}}}});
}

inline double greatest_difference(const Image& a, const Image& b) {
    double greatest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        if (i % 4 != 3) greatest = std::max(greatest, std::abs(double{a.rgba[i]} - b.rgba[i]));
    return greatest;
}

}  // namespace sheer::test
