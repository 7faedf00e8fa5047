#pragma once
#include <memory>
#include <string>

namespace sheer::gl {

/// GLFW, of which there is one per process: initialised with the first of these objects, terminated with the last.
/// Windows must be destroyed before. Main thread only, as GLFW demands.
class GlfwLibrary {
  public:
    /// Throws Unsupported with GLFW's reason, such as no display.
    static std::shared_ptr<GlfwLibrary> acquire();

    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
    ~GlfwLibrary();

  private:
    GlfwLibrary();
};

/// The text of GLFW's last error on this thread, which is cleared.
std::string take_glfw_error();

}  // namespace sheer::gl
