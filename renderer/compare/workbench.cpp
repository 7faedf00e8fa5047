#include "renderer/compare/workbench.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <new>

namespace sheer {

namespace {

constexpr int frames_for_flicker = 4;

/// Restores the spec's background, even after a failure.
class OtherBackground {
  public:
    OtherBackground(Target& target, const std::array<float, 3>& other, const std::array<float, 3>& own)
        : m_target(target), m_own(own) {
        m_target.set_background(other);
    }
    ~OtherBackground() { m_target.set_background(m_own); }
    OtherBackground(const OtherBackground&) = delete;
    OtherBackground& operator=(const OtherBackground&) = delete;

  private:
    Target& m_target;
    const std::array<float, 3>& m_own;
};

}  // namespace

void Workbench::tell(double from, double to, std::size_t index, std::size_t count, const std::string& stage) const {
    m_progress(from + (to - from) * static_cast<double>(index) / static_cast<double>(count), stage);
}

std::optional<Trouble> Workbench::attempt(const std::string& doing, const std::function<void()>& step) {
    try {
        step();
        m_context.check(doing);
        return std::nullopt;
    } catch (const SpecError&) {
        throw;
    } catch (const ContextLost&) {
        throw;
    } catch (const Unsupported& unsupported) {
        return after(doing, {report::ResultStatus::unsupported, unsupported.what()});
    } catch (const RenderError& error) {
        return after(doing, {report::ResultStatus::failed, error.what()});
    } catch (const std::bad_alloc&) {
        return after(doing, {report::ResultStatus::failed, "memory ran out"});
    } catch (const std::exception& error) {
        // Its text may name files and libraries of the host.
        spdlog::error("{}: {}", doing, error.what());
        return after(doing, {report::ResultStatus::failed, "an error within the renderer; its log has the details"});
    }
}

/// Pending errors belong to what failed, not to the next step.
Trouble Workbench::after(const std::string& doing, Trouble trouble) {
    try {
        m_context.check(doing);
    } catch (const ContextLost&) {
        throw;
    } catch (const RenderError& error) {
        trouble.reason += fmt::format("; {}", error.what());
    }
    if (trouble.status == report::ResultStatus::failed && !trouble.reason.starts_with(doing))
        trouble.reason = fmt::format("{}: {}", doing, trouble.reason);
    if (trouble.reason.find("GL_OUT_OF_MEMORY") != std::string::npos)
        add_note(m_notes, {"out-of-memory",
                           "Memory ran out while " + doing +
                               "; OpenGL does not guarantee what is drawn after that, so check the pictures.",
                           ""});
    return trouble;
}

bool Workbench::attempt_for(MethodResult& result, const std::string& doing, const std::function<void()>& step) {
    std::optional<Trouble> trouble = attempt(doing, step);
    if (!trouble) return true;
    const MethodSpec method = result.method;
    result = {};
    result.method = method;
    result.status = trouble->status;
    result.reason = trouble->reason;
    return false;
}

gl::FrameSample Workbench::frame(bool timed, const std::function<void(gl::FrameTimer&)>& draw) {
    gl::FrameTimer::Frame frame = m_timer.frame(timed);
    draw(m_timer);
    return frame.end();
}

gl::FrameSample Workbench::render(Method& method, bool timed) {
    return frame(timed, [&method](gl::FrameTimer& timer) { method.render(timer); });
}

std::unique_ptr<Method> Workbench::make_method(const MethodSpec& method, const Scene& scene,
                                               const Target& target) const {
    return find_method(method.id)->make({m_context, m_context.gl(), scene, target}, method.parameters);
}

nlohmann::json Workbench::findings(Method& method) {
    nlohmann::json found;
    frame(false, [&](gl::FrameTimer& timer) { found = method.findings(timer); });
    return found;
}

Image Workbench::over_background(const std::array<float, 3>& background, Method& method, Target& target,
                                 const Image& own) {
    if (background == m_spec.image.background) return own;
    const OtherBackground other(target, background, m_spec.image.background);
    method.restart();
    render(method, false);
    return target.read();
}

std::vector<Image8> Workbench::frames(Method& method, const Target& target) {
    std::vector<Image8> pictures;
    for (int number = 0; number < frames_for_flicker; ++number) {
        method.take_noise_of(number);
        render(method, false);
        pictures.push_back(quantize(target.read()));
    }
    method.take_noise_of(0);
    return pictures;
}

Backdrops Workbench::over_backdrops(Method& method, Target& target, const Image& own) {
    return {over_background({0, 0, 0}, method, target, own), over_background({1, 1, 1}, method, target, own)};
}

}  // namespace sheer
