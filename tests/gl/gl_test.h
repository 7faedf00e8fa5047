#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstdlib>
#include <sstream>

#include "renderer/core/errors.h"
#include "renderer/gl/context.h"
#include "renderer/gl/objects.h"

namespace sheer::gl {

/// Covers the whole viewport.
inline constexpr std::string_view full_screen_vertex_shader = R"(#version 450
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
)";

/// A test that runs on each kind of context; "glfw" is skipped if there is no display.
class EachContext : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        if (std::string_view(GetParam()) == "glfw" && std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY";
        m_context = make_context();
    }

    std::unique_ptr<Context> make_context(std::vector<std::string> disabled_workarounds = {}) {
        return create_context({GetParam(), "", std::move(disabled_workarounds)});
    }

    Context& context() { return *m_context; }
    const Functions& gl() { return m_context->gl(); }

    std::unique_ptr<Context> m_context;
};

inline const auto every_context = testing::Values("egl", "osmesa", "glfw");
inline const auto context_name = [](const testing::TestParamInfo<const char*>& info) { return info.param; };

using Pixel = std::array<GLubyte, 4>;

/// A framebuffer of one color texture.
struct Target {
    Target(const Functions& functions, int size_px, GLenum format = GL_RGBA8)
        : gl(functions), color(make_texture_2d(gl, "target", format, size_px, size_px)) {
        const std::array colors{color.id()};
        framebuffer = make_framebuffer(gl, "target", colors, 0);
    }

    void clear(const Pixel& pixel) const {
        std::array<GLfloat, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) value[i] = static_cast<float>(pixel[i]) / 255.0F;
        gl.ClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, 0, value.data());
    }

    Pixel read(int x, int y) const {
        Pixel pixel{};
        gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
        gl.ReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
        return pixel;
    }

    const Functions& gl;
    Texture color;
    Framebuffer framebuffer;
};

/// The text of the exception of type E that `action` throws; fails the test if it throws none.
template <typename E, typename Action>
std::string message_of(Action&& action) {
    try {
        action();
    } catch (const E& error) {
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

/// Collects the log's lines, as "level text", while it exists.
class LogCapture {
  public:
    LogCapture() : m_before(spdlog::default_logger()) {
        auto logger = std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(m_lines));
        logger->set_pattern("%l %v");
        logger->set_level(spdlog::level::trace);
        spdlog::set_default_logger(std::move(logger));
    }
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;
    ~LogCapture() { spdlog::set_default_logger(m_before); }

    std::string text() const { return m_lines.str(); }

  private:
    std::ostringstream m_lines;
    std::shared_ptr<spdlog::logger> m_before;
};

}  // namespace sheer::gl
