#include "renderer/gl/glfw_library.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "renderer/core/errors.h"

namespace sheer::gl {

std::string take_glfw_error() {
    const char* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || text == nullptr ? "GLFW gave no reason" : text;
}

GlfwLibrary::GlfwLibrary() {
    if (glfwInit() == GLFW_FALSE) throw Unsupported("GLFW cannot start: " + take_glfw_error());
}

GlfwLibrary::~GlfwLibrary() {
    glfwTerminate();
}

std::shared_ptr<GlfwLibrary> GlfwLibrary::acquire() {
    // GLFW does not count how often it is initialised, and terminating it destroys all windows of the process.
    static std::weak_ptr<GlfwLibrary> alive;
    std::shared_ptr<GlfwLibrary> library = alive.lock();
    if (library == nullptr) {
        library = std::shared_ptr<GlfwLibrary>(new GlfwLibrary);
        alive = library;
    }
    return library;
}

}  // namespace sheer::gl
