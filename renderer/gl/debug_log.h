#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/functions.h"

namespace sheer::gl {

/// What KHR_debug says about one context.
///
/// Each message goes to the log at once, preceded by the debug groups in which it was raised. One of high severity, or
/// of type error, is kept for check(), which also names the objects that it mentions. GL must not be called from within
/// its own callback, so the log has only the objects' numbers. Messages of the shader compiler are not kept: the code
/// that compiles a shader asks for the result and the text.
class DebugLog {
  public:
    /// `name` stands before each line in the log.
    explicit DebugLog(std::string name) : m_name(std::move(name)) {}
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;

    /// Directs the messages of the current context here; this object must outlive the context.
    void attach(const Functions& gl);

    /// Throws RenderError with the messages kept since the last call, or with what glGetError says. `where` comes
    /// first in its text. Throws ContextLost if the device was reset. The messages and the errors are then cleared.
    void check(const Functions& gl, std::string_view where);

  private:
    static void GLAD_API_PTR on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                        const GLchar* message, const void* user);
    void add(GLenum source, GLenum type, GLenum severity, std::string_view message);

    std::string m_name;
    std::vector<std::string> m_groups;  ///< the debug groups now open, outermost first
    std::vector<std::string> m_kept;
};

}  // namespace sheer::gl
