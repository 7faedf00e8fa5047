#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
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
    /// or a part of the renderer's name, case-insensitive.
    std::string device;
    std::vector<std::string> disabled_workarounds;  ///< names of workarounds.h
};

/// A current OpenGL 4.5 core context, owned by a unique_ptr; destroyed with its window system objects.
///
/// KHR_debug messages go to the log; one of high severity, or of type error, is kept and thrown as RenderError by
/// `check()`, with the labels of the objects that it mentions: see debug_log.h. Contexts of every kind can live side
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
    /// turns debug output on, chooses the workarounds. Throws RenderError if it is not at least OpenGL 4.5.
    void initialize(const Resolver& resolve, DeviceInfo device, const ContextRequest& request);

  private:
    Functions m_gl{};
    DeviceInfo m_device;
    Workarounds m_workarounds;
    std::unique_ptr<DebugLog> m_debug_log;
};

/// Throws Unsupported with the reason for each attempt if no such context can be made, e.g. GLFW without a display;
/// std::invalid_argument for a kind or a workaround that does not exist. The new context is current.
std::unique_ptr<Context> create_context(const ContextRequest& request);

/// The same for a program that exists only to render: the choice is first made in a child (forked.h), so that a driver
/// that crashes or hangs when it is tried is left out, with that reason, and the next device is tried. Call it before
/// anything else of OpenGL and while only one thread is running.
std::unique_ptr<Context> open_device(const ContextRequest& request);
/// For a GLFW window, which creates its own context: throws Unsupported if its driver crashes or hangs.
void require_sound_window();

/// What can be rendered on here: every EGL device and the surfaceless platform, OSMesa, and GLFW if there is a display.
/// A kind that is not available is listed with `error` instead of the strings, so that the user sees why.
/// Each is tried in a child, so a driver that crashes only affects its own line; see open_device() for when to call it.
struct ListedDevice {
    DeviceInfo info;
    std::optional<std::string> error;
};
std::vector<ListedDevice> list_devices();

/// The objects of GET /devices and of a report's `device` (without cpu, which GL does not know, and without the
/// hundreds of extensions).
nlohmann::json to_json(const DeviceInfo& info);

}  // namespace sheer::gl
