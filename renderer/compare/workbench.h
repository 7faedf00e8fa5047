#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/compare/compare.h"
#include "renderer/methods/shared/method.h"

namespace sheer {

/// A failure that does not stop the rest of the comparison.
struct Trouble {
    report::ResultStatus status;  ///< unsupported or failed
    std::string reason;
};

/// Shared by the stages of a comparison: frames of methods, and the handling of their failures.
class Workbench {
  public:
    /// All references must outlive it. `notes` are the run's.
    Workbench(const Spec& spec, gl::Context& context, const ProgressFunction& progress, std::vector<Note>& notes)
        : m_spec(spec), m_context(context), m_progress(progress), m_notes(notes), m_timer(context) {}

    const gl::Functions& gl() const { return m_context.gl(); }
    const gl::DeviceInfo& device() const { return m_context.device(); }
    /// Throws RenderError for OpenGL errors since the last call; `doing` says what was done since then.
    void check(const std::string& doing) const { m_context.check(doing); }
    /// Reports that step `index` of `count` begins, in a stage that takes the job's progress from the fraction `from`
    /// to `to`.
    void tell(double from, double to, std::size_t index, std::size_t count, const std::string& stage) const;

    /// Runs `step`, which `doing` names. Returns what went wrong in it; throws only if the user's shading does not
    /// compile (SpecError) or the device is lost (ContextLost).
    std::optional<Trouble> attempt(const std::string& doing, const std::function<void()>& step);
    /// The same for a step of one method; if it fails, the method's result says only what went wrong. Returns whether
    /// the step succeeded.
    bool attempt_for(MethodResult& result, const std::string& doing, const std::function<void()>& step);

    gl::FrameSample frame(bool timed, const std::function<void(gl::FrameTimer&)>& draw);
    gl::FrameSample render(Method& method, bool timed);
    std::unique_ptr<Method> make_method(const MethodSpec& method, const Scene& scene, const Target& target) const;
    nlohmann::json findings(Method& method);
    /// Consecutive frames of the method while nothing in the scene moves, as shown.
    std::vector<Image8> frames(Method& method, const Target& target);
    /// The method's pictures over a black and a white background; `own` is its picture over the spec's background.
    Backdrops over_backdrops(Method& method, Target& target, const Image& own);

  private:
    Trouble after(const std::string& doing, Trouble trouble);
    Image over_background(const std::array<float, 3>& background, Method& method, Target& target, const Image& own);

    const Spec& m_spec;
    gl::Context& m_context;
    const ProgressFunction& m_progress;
    std::vector<Note>& m_notes;
    gl::FrameTimer m_timer;
};

}  // namespace sheer
