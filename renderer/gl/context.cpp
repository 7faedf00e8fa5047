#include "renderer/gl/context.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>

#include "renderer/core/errors.h"
#include "renderer/gl/debug_log.h"

namespace sheer::gl {
namespace {

/// Checked before anything is loaded, so that an old driver is reported as old rather than as lacking some function.
void require_version(const Resolver& resolve) {
    const auto get_integer = reinterpret_cast<PFNGLGETINTEGERVPROC>(resolve("glGetIntegerv"));
    if (get_integer == nullptr) throw RenderError("the OpenGL driver lacks glGetIntegerv");
    GLint major = 0;
    GLint minor = 0;
    get_integer(GL_MAJOR_VERSION, &major);
    get_integer(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 45) {
        throw RenderError(fmt::format("the driver has OpenGL {}.{}, but 4.5 is needed", major, minor));
    }
}

std::string string_of(const Functions& gl, GLenum name) {
    const GLubyte* text = gl.GetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

std::vector<std::string> sorted_extensions(const Functions& gl) {
    GLint count = 0;
    gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
    std::vector<std::string> names;
    for (GLint i = 0; i < count; ++i) {
        names.emplace_back(reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
    }
    std::ranges::sort(names);
    return names;
}

bool is_software(std::string renderer) {
    for (char& c : renderer) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::array<std::string_view, 5> rasterisers{"llvmpipe", "softpipe", "swr", "software", "swiftshader"};
    return std::ranges::any_of(rasterisers,
                               [&](std::string_view name) { return renderer.find(name) != renderer.npos; });
}

}  // namespace

Context::Context() = default;
Context::~Context() = default;

void Context::initialize(const Resolver& resolve, DeviceInfo device, const ContextRequest& request) {
    require_version(resolve);
    m_gl = load_functions(resolve);
    m_debug_log = std::make_unique<DebugLog>(device.name);
    m_debug_log->attach(m_gl);
    m_device = std::move(device);
    m_device.renderer = string_of(m_gl, GL_RENDERER);
    m_device.vendor = string_of(m_gl, GL_VENDOR);
    m_device.gl_version = string_of(m_gl, GL_VERSION);
    m_device.glsl_version = string_of(m_gl, GL_SHADING_LANGUAGE_VERSION);
    m_device.software = is_software(m_device.renderer);
    m_device.extensions = sorted_extensions(m_gl);
    m_workarounds = Workarounds(m_device, request.disabled_workarounds);
    if (m_workarounds.has("keep-programs")) m_gl.DeleteProgram = [](GLuint) {};
    spdlog::debug("{} ({}): {}, OpenGL {}", m_device.name, m_device.platform, m_device.renderer, m_device.gl_version);
    check("making the context");
}

bool Context::has_extension(std::string_view name) const {
    return std::ranges::binary_search(m_device.extensions, name, std::less<>{});
}

void Context::check(std::string_view where) const {
    m_debug_log->check(m_gl, where);
}

nlohmann::json to_json(const DeviceInfo& info) {
    return {{"context", info.context},           {"index", info.index},       {"name", info.name},
            {"renderer", info.renderer},         {"vendor", info.vendor},     {"gl_version", info.gl_version},
            {"glsl_version", info.glsl_version}, {"platform", info.platform}, {"software", info.software}};
}

}  // namespace sheer::gl
