#pragma once
#include <map>
#include <string>
#include <string_view>

#include "renderer/gl/functions.h"

namespace sheer::gl {

/// Answers the queries for making a context: the version and the strings, which `Device` has as the constants `major`,
/// `minor` and `renderer`. Every other function does nothing.
template <typename Device>
class FakeDriver {
  public:
    static void* resolve(const char* name) {
        static const std::map<std::string_view, void*> answers{
            {"glGetIntegerv", reinterpret_cast<void*>(&get_integer)},
            {"glGetString", reinterpret_cast<void*>(&get_string)},
            {"glGetError", reinterpret_cast<void*>(&get_error)},
            {"glDebugMessageCallback", reinterpret_cast<void*>(&debug_message_callback)},
            {"glDebugMessageControl", reinterpret_cast<void*>(&debug_message_control)}};
        const auto found = answers.find(name);
        return found == answers.end() ? reinterpret_cast<void*>(&enable) : found->second;
    }

  private:
    static void GLAD_API_PTR get_integer(GLenum name, GLint* value) {
        *value = name == GL_MAJOR_VERSION ? Device::major : name == GL_MINOR_VERSION ? Device::minor : 0;
    }
    static const GLubyte* GLAD_API_PTR get_string(GLenum name) {
        static const std::string version = std::to_string(Device::major) + "." + std::to_string(Device::minor);
        const char* text = name == GL_RENDERER ? Device::renderer : name == GL_VERSION ? version.c_str() : "";
        return reinterpret_cast<const GLubyte*>(text);
    }
    static GLenum GLAD_API_PTR get_error() { return GL_NO_ERROR; }
    static void GLAD_API_PTR enable(GLenum) {}
    static void GLAD_API_PTR debug_message_callback(GLDEBUGPROC, const void*) {}
    static void GLAD_API_PTR debug_message_control(GLenum, GLenum, GLenum, GLsizei, const GLuint*, GLboolean) {}
};

}  // namespace sheer::gl
