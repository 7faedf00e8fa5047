#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

#include "renderer/core/errors.h"
#include "renderer/gl/context_kinds.h"

namespace sheer::gl {
namespace {

/// The name of the error that eglGetError returns.
std::string last_error() {
    constexpr std::array<std::string_view, 15> names{
        "EGL_SUCCESS",       "EGL_NOT_INITIALIZED", "EGL_BAD_ACCESS",        "EGL_BAD_ALLOC",
        "EGL_BAD_ATTRIBUTE", "EGL_BAD_CONFIG",      "EGL_BAD_CONTEXT",       "EGL_BAD_CURRENT_SURFACE",
        "EGL_BAD_DISPLAY",   "EGL_BAD_MATCH",       "EGL_BAD_NATIVE_PIXMAP", "EGL_BAD_NATIVE_WINDOW",
        "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",     "EGL_CONTEXT_LOST"};
    const EGLint error = eglGetError();
    const auto index = static_cast<std::size_t>(error - EGL_SUCCESS);
    return index < names.size() ? std::string(names[index]) : fmt::format("error {:#x}", error);
}

/// Whether a space-separated list of extensions contains this one.
bool lists(const char* extensions, std::string_view name) {
    return extensions != nullptr &&
           fmt::format(" {} ", extensions).find(fmt::format(" {} ", name)) != std::string::npos;
}

bool client_has(std::string_view extension) {
    return lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension);
}

template <typename Pointer>
Pointer egl_function(const char* name) {
    const auto function = reinterpret_cast<Pointer>(eglGetProcAddress(name));
    if (function == nullptr) throw Unsupported(fmt::format("the EGL library lacks {}", name));
    return function;
}

/// An initialised display. It is never terminated: EGL returns the same display to everyone who asks for the same
/// platform, so terminating it here would terminate it for the other contexts of this process.
EGLDisplay open_display(EGLenum platform, void* native) {
    const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    EGLDisplay display = get_display(platform, native, nullptr);
    if (display == EGL_NO_DISPLAY) throw Unsupported("EGL has no such display: " + last_error());
    if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
        throw Unsupported("the EGL display cannot be initialised: " + last_error());
    }
    return display;
}

class EglHandle {
  public:
    EglHandle(EGLenum platform, void* native) : m_display(open_display(platform, native)) {
        if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) throw Unsupported("EGL has no OpenGL here: " + last_error());
        constexpr std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                                   4,
                                                   EGL_CONTEXT_MINOR_VERSION,
                                                   5,
                                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                   EGL_CONTEXT_OPENGL_DEBUG,
                                                   EGL_TRUE,
                                                   EGL_NONE};
        m_context = eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        if (m_context == EGL_NO_CONTEXT) throw Unsupported("no OpenGL 4.5 core context: " + last_error());
    }
    EglHandle(const EglHandle&) = delete;
    EglHandle& operator=(const EglHandle&) = delete;
    ~EglHandle() {
        if (eglGetCurrentContext() == m_context) {
            eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglDestroyContext(m_display, m_context);
    }

    void make_current() {
        // EGL does nothing if it believes that the context is already current, and it still believes so after OSMesa
        // has made its own current without EGL's knowledge.
        eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context) == EGL_FALSE) {
            throw RenderError("the EGL context cannot be made current without a surface: " + last_error());
        }
    }

  private:
    EGLDisplay m_display;
    EGLContext m_context = EGL_NO_CONTEXT;
};

class EglContext final : public Context {
  public:
    EglContext(EGLenum platform, void* native, const DeviceInfo& info, const ContextRequest& request)
        : m_handle(platform, native) {
        m_handle.make_current();
        initialize([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); }, info, request);
    }

    void make_current() override { m_handle.make_current(); }

  private:
    EglHandle m_handle;
};

Candidate candidate(int index, std::string platform_name, Expectation expectation, EGLenum platform, void* native) {
    DeviceInfo info;
    info.context = "egl";
    info.index = index;
    info.name = fmt::format("egl:{}", index);
    info.platform = std::move(platform_name);
    return {std::move(info), expectation, [platform, native](const DeviceInfo& device, const ContextRequest& request) {
                if (platform == EGL_PLATFORM_SURFACELESS_MESA && !client_has("EGL_MESA_platform_surfaceless")) {
                    throw Unsupported("the EGL library lacks EGL_MESA_platform_surfaceless");
                }
                return std::make_unique<EglContext>(platform, native, device, request);
            }};
}

std::vector<EGLDeviceEXT> devices() {
    if (!client_has("EGL_EXT_platform_device") || !client_has("EGL_EXT_device_enumeration")) return {};
    const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (query(0, nullptr, &count) == EGL_FALSE) return {};
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (query(count, found.data(), &count) == EGL_FALSE) return {};
    found.resize(static_cast<std::size_t>(count));
    return found;
}

Expectation expectation_of(EGLDeviceEXT device) {
    if (!client_has("EGL_EXT_device_query")) return Expectation::gpu;
    const auto query = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const bool software = lists(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
    return software ? Expectation::software : Expectation::gpu;
}

}  // namespace

std::vector<Candidate> egl_candidates() {
    std::vector<Candidate> all;
    int index = 0;
    for (EGLDeviceEXT device : devices()) {
        all.push_back(candidate(index++, "EGL device", expectation_of(device), EGL_PLATFORM_DEVICE_EXT, device));
    }
    all.push_back(candidate(index, "EGL surfaceless", Expectation::last_resort, EGL_PLATFORM_SURFACELESS_MESA,
                            EGL_DEFAULT_DISPLAY));
    return all;
}

}  // namespace sheer::gl
