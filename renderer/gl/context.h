#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/gl/functions.h"
#include "renderer/gl/workarounds.h"

namespace sheer::gl {

/// What a context runs on, as the report's `device` says it.
struct DeviceInfo {
    std::string context;  ///< "egl", "osmesa" or "glfw"
    int index = 0;        ///< position in list_devices() among the devices of this context kind
    std::string name;     ///< how --device names it, e.g. "egl:0"
    std::string renderer, vendor, gl_version, glsl_version;
    std::string platform;   ///< how the context was made, e.g. "EGL device", "EGL surfaceless"
    bool software = false;  ///< a software rasteriser (llvmpipe, softpipe, swr): times do not predict a GPU
    std::vector<std::string> extensions;
};

/// Which context to make. "auto" tries EGL, then OSMesa.
struct ContextRequest {
    std::string context = "auto";  ///< auto, egl, osmesa, glfw
    std::string device;            ///< empty for the first that works; else an index or a part of the renderer's name
    std::vector<std::string> disabled_workarounds;  ///< names of workarounds.h
};

/// A current OpenGL 4.5 core context. Move-only by unique_ptr; destroyed with its window system objects.
///
/// KHR_debug messages go to the log with the labels of the objects; one of high severity, or of type error, is kept and
/// thrown as RenderError by `check()`.
class Context {
  public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current on the calling thread.
    virtual void make_current() = 0;

    const Functions& gl() const { return m_gl; }
    const DeviceInfo& device() const { return m_device; }
    const Workarounds& workarounds() const { return m_workarounds; }
    bool has_extension(std::string_view name) const;

    /// Throws RenderError with the messages kept since the last call, or for glGetError.
    /// `where` says what was being done, for the message.
    void check(std::string_view where) const;

  protected:
    Context() = default;
    /// Called by each implementation once its context is current: loads the functions, reads the device's strings,
    /// turns debug output on, picks the workarounds. Throws RenderError if it is not at least OpenGL 4.5.
    void initialize(const Resolver& resolve, DeviceInfo device, const ContextRequest& request);

  private:
    struct DebugLog;
    Functions m_gl;
    DeviceInfo m_device;
    Workarounds m_workarounds;
    std::shared_ptr<DebugLog> m_debug_log;
};

/// Throws Unsupported with the reason of each thing tried if no such context can be had, e.g. GLFW without a display.
std::unique_ptr<Context> create_context(const ContextRequest& request);

/// What can be rendered on here: every EGL device and the surfaceless platform, OSMesa, GLFW where there is a display.
/// A kind that cannot be had is listed with `error` in place of the strings, so that the user sees why.
struct ListedDevice {
    DeviceInfo info;
    std::optional<std::string> error;
};
std::vector<ListedDevice> list_devices();

/// The objects of GET /devices and of a report's `device` (without cpu, which is not GL's to say).
nlohmann::json to_json(const DeviceInfo& info);

}  // namespace sheer::gl
