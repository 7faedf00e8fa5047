#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/gl/functions.h"
#include "renderer/gl/workarounds.h"

namespace sheer::gl {

class DebugLog;

/// What a context runs on, as the report's `device` says it.
struct DeviceInfo {
    std::string context;  ///< "egl", "osmesa" or "glfw"
    int index = 0;        ///< position in list_devices() among the devices of this context kind
    std::string name;     ///< how --device names it, e.g. "egl:0"
    std::string renderer, vendor, gl_version, glsl_version;
    std::string platform;   ///< how the context was made, e.g. "EGL device", "EGL surfaceless"
    bool software = false;  ///< a software rasteriser (llvmpipe, softpipe, swr): times do not predict a GPU
    std::vector<std::string> extensions;  ///< sorted
};

/// Which context to make. "auto" tries EGL, then OSMesa.
struct ContextRequest {
    std::string context = "auto";  ///< auto, egl, osmesa, glfw
    /// Empty for the first GPU, else the first software renderer; or an index, a name as of list_devices() ("egl:1"),
    /// or a part of the renderer's name without regard to case.
    std::string device;
    std::vector<std::string> disabled_workarounds;  ///< names of workarounds.h
};

/// A current OpenGL 4.5 core context. Move-only by unique_ptr; destroyed with its window system objects.
///
/// KHR_debug messages go to the log; one of high severity, or of type error, is kept and thrown as RenderError by
/// `check()`, with the labels of the objects that it speaks of: see debug_log.h. Contexts of every kind can live side
/// by side; destroying one may leave none current, so make the next one current before it is used.
class Context {
  public:
    virtual ~Context();
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
    Context();
    /// Called by each implementation once its context is current: loads the functions, reads the device's strings,
    /// turns debug output on, picks the workarounds. Throws RenderError if it is not at least OpenGL 4.5.
    void initialize(const Resolver& resolve, DeviceInfo device, const ContextRequest& request);

  private:
    Functions m_gl;
    DeviceInfo m_device;
    Workarounds m_workarounds;
    std::unique_ptr<DebugLog> m_debug_log;
};

/// Throws Unsupported with the reason of each thing tried if no such context can be had, e.g. GLFW without a display;
/// std::invalid_argument for a kind or a workaround that does not exist. The new context is current.
std::unique_ptr<Context> create_context(const ContextRequest& request);

/// The same for a program that lives for what it renders: the choice is first made in a child (forked.h), so that a
/// driver that crashes or hangs while it is looked at is left out, with that reason, and the next device has its turn.
/// To be called before any other of OpenGL, with one thread running.
std::unique_ptr<Context> open_device(const ContextRequest& request);
/// For a window of GLFW, whose context is made with it: throws Unsupported if its driver crashes or hangs.
void require_sound_window();

/// What can be rendered on here: every EGL device and the surfaceless platform, OSMesa, GLFW where there is a display.
/// A kind that cannot be had is listed with `error` in place of the strings, so that the user sees why.
/// Each is looked at in a child, so that a driver that crashes is its own line; call it as open_device().
struct ListedDevice {
    DeviceInfo info;
    std::optional<std::string> error;
};
std::vector<ListedDevice> list_devices();

/// The objects of GET /devices and of a report's `device` (without cpu, which is not GL's to say, and without the
/// extensions, which are hundreds).
nlohmann::json to_json(const DeviceInfo& info);

}  // namespace sheer::gl
