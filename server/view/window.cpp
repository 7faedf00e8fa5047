#include "server/view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "renderer/core/errors.h"

namespace sheer::view {

namespace {

/// Margin to the screen's work area, for the frame that a window manager adds.
constexpr int frame_px = 64;

Size fit_screen(Size size) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return size;
    int x = 0, y = 0, width_px = 0, height_px = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width_px, &height_px);
    const double scale = std::min({1.0, double(std::max(1, width_px - frame_px)) / size.width_px,
                                   double(std::max(1, height_px - frame_px)) / size.height_px});
    return {std::max(1, static_cast<int>(size.width_px * scale)),
            std::max(1, static_cast<int>(size.height_px * scale))};
}

}  // namespace

Window::Window(Size size, const gl::ContextRequest& request) : m_library(gl::GlfwLibrary::acquire()) {
    glfwDefaultWindowHints();
    // As the hidden window of context_glfw.cpp.
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    const Size fitting = fit_screen(size);
    m_window = glfwCreateWindow(fitting.width_px, fitting.height_px, "Sheer", nullptr, nullptr);
    if (m_window == nullptr) throw Unsupported("GLFW has no window with OpenGL 4.5: " + gl::take_glfw_error());
    try {
        Window::make_current();
        gl::DeviceInfo info;
        info.context = "glfw";
        info.name = "glfw:0";
        info.platform = "GLFW window";
        initialize([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }, info, request);
    } catch (...) {
        glfwDestroyWindow(m_window);
        throw;
    }
    glfwSetWindowUserPointer(m_window, this);
    glfwSetKeyCallback(m_window, on_key);
    glfwSetCharCallback(m_window, on_character);
    glfwSetCursorPosCallback(m_window, on_mouse);
    glfwSetScrollCallback(m_window, on_wheel);
}

Window::~Window() {
    glfwDestroyWindow(m_window);
}

void Window::make_current() {
    glfwMakeContextCurrent(m_window);
}

Size Window::size() const {
    Size size;
    glfwGetFramebufferSize(m_window, &size.width_px, &size.height_px);
    return size;
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(m_window, title.c_str());
}

void Window::swap() {
    glfwSwapBuffers(m_window);
}

std::vector<Event> Window::wait() {
    glfwWaitEvents();
    return std::exchange(m_events, {});
}

void Window::close() {
    glfwSetWindowShouldClose(m_window, GLFW_TRUE);
}

bool Window::is_closing() const {
    return glfwWindowShouldClose(m_window) == GLFW_TRUE;
}

Window& Window::of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void Window::on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
    const bool comes_as_character = key == GLFW_KEY_KP_ADD || key == GLFW_KEY_KP_SUBTRACT;
    if (action == GLFW_RELEASE || comes_as_character) return;
    of(window).m_events.emplace_back(KeyPress{key, (modifiers & GLFW_MOD_SHIFT) != 0});
}

void Window::on_character(GLFWwindow* window, unsigned character) {
    if (character == '+') of(window).m_events.emplace_back(KeyPress{GLFW_KEY_KP_ADD});
    if (character == '-') of(window).m_events.emplace_back(KeyPress{GLFW_KEY_KP_SUBTRACT});
}

void Window::on_mouse(GLFWwindow* window, double x, double y) {
    Window& self = of(window);
    int width = 1, height = 1;
    glfwGetWindowSize(window, &width, &height);
    const Size size = self.size();
    const glm::dvec2 at(x * size.width_px / std::max(1, width), y * size.height_px / std::max(1, height));
    const bool dragging = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    self.m_events.emplace_back(MouseMove{at, at - self.m_mouse, dragging});
    self.m_mouse = at;
}

void Window::on_wheel(GLFWwindow* window, double, double y) {
    of(window).m_events.emplace_back(Wheel{y});
}

}  // namespace sheer::view
