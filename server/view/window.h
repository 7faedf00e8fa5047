#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "renderer/gl/context.h"
#include "renderer/gl/glfw_library.h"

struct GLFWwindow;

namespace sheer::view {

struct Size {
    int width_px = 0;
    int height_px = 0;
    bool operator==(const Size&) const = default;
};

struct KeyPress {
    int key = 0;  ///< GLFW_KEY_...; any key that types + or - becomes GLFW_KEY_KP_ADD or GLFW_KEY_KP_SUBTRACT
    bool shift = false;
};
/// In pixels of the window's picture, from the top left.
struct MouseMove {
    glm::dvec2 at, moved;
    bool dragging = false;  ///< with the left button held
};
struct Wheel {
    double steps = 0;  ///< away from the user is positive
};
using Event = std::variant<KeyPress, MouseMove, Wheel>;

/// A window on the screen with an OpenGL context. Main thread only, as GLFW demands.
class Window final : public gl::Context {
  public:
    /// The window's picture has this size, or is scaled down to fit the screen.
    /// Throws Unsupported with GLFW's reason, such as no display.
    Window(Size size, const gl::ContextRequest& request);
    ~Window() override;

    void make_current() override;
    Size size() const;
    void set_title(const std::string& title);
    /// Shows what has been drawn into framebuffer 0.
    void swap();
    /// Waits until something happens and returns the user's actions, or nothing if the window only needs to be redrawn.
    std::vector<Event> wait();
    void close();
    bool is_closing() const;

  private:
    /// GLFW is C: its callbacks only note what happened.
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_character(GLFWwindow* window, unsigned character);
    static void on_mouse(GLFWwindow* window, double x, double y);
    static void on_wheel(GLFWwindow* window, double x, double y);
    static Window& of(GLFWwindow* window);

    std::shared_ptr<gl::GlfwLibrary> m_library;
    GLFWwindow* m_window = nullptr;
    std::vector<Event> m_events;
    glm::dvec2 m_mouse{0};
};

}  // namespace sheer::view
