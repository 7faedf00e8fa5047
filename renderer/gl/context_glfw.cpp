#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "renderer/core/errors.h"
#include "renderer/gl/context_kinds.h"
#include "renderer/gl/glfw_library.h"

namespace sheer::gl {
namespace {

class GlfwHandle {
  public:
    GlfwHandle() : m_library(GlfwLibrary::acquire()) {
        glfwDefaultWindowHints();
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
        // EGL and GLX refuse to share a thread; GLX ends the process.
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
        m_window = glfwCreateWindow(1, 1, "sheer", nullptr, nullptr);
        if (m_window == nullptr) throw Unsupported("GLFW has no OpenGL 4.5 core context: " + take_glfw_error());
    }
    GlfwHandle(const GlfwHandle&) = delete;
    GlfwHandle& operator=(const GlfwHandle&) = delete;
    ~GlfwHandle() { glfwDestroyWindow(m_window); }

    void make_current() {
        // See EglHandle::make_current.
        glfwMakeContextCurrent(nullptr);
        glfwMakeContextCurrent(m_window);
        if (glfwGetCurrentContext() != m_window) {
            throw RenderError("the GLFW context cannot be made current: " + take_glfw_error());
        }
    }

  private:
    std::shared_ptr<GlfwLibrary> m_library;
    GLFWwindow* m_window = nullptr;
};

class GlfwContext final : public Context {
  public:
    GlfwContext(const DeviceInfo& info, const ContextRequest& request) {
        m_handle.make_current();
        initialize([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }, info, request);
    }

    void make_current() override { m_handle.make_current(); }

  private:
    GlfwHandle m_handle;
};

}  // namespace

std::vector<Candidate> glfw_candidates() {
    DeviceInfo info;
    info.context = "glfw";
    info.name = "glfw:0";
    info.platform = "GLFW";
    return {{std::move(info), Expectation::gpu, [](const DeviceInfo& device, const ContextRequest& request) {
                 return std::make_unique<GlfwContext>(device, request);
             }}};
}

}  // namespace sheer::gl
