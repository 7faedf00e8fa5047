#include "renderer/gl/debug_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <utility>

#include "renderer/core/errors.h"

namespace sheer::gl {
namespace {

/// If a loop raises a thousand errors, the first few are enough.
constexpr std::size_t max_kept = 16;

struct Noun {
    std::string_view word;
    GLenum identifier;
    PFNGLISBUFFERPROC Functions::*exists;
};

/// A word comes before the words that are its endings.
constexpr std::array nouns{
    Noun{"framebuffer", GL_FRAMEBUFFER, &Functions::IsFramebuffer},
    Noun{"renderbuffer", GL_RENDERBUFFER, &Functions::IsRenderbuffer},
    Noun{"buffer", GL_BUFFER, &Functions::IsBuffer},
    Noun{"texture", GL_TEXTURE, &Functions::IsTexture},
    Noun{"program", GL_PROGRAM, &Functions::IsProgram},
    Noun{"shader", GL_SHADER, &Functions::IsShader},
    Noun{"query", GL_QUERY, &Functions::IsQuery},
    Noun{"sampler", GL_SAMPLER, &Functions::IsSampler},
    Noun{"vertex array", GL_VERTEX_ARRAY, &Functions::IsVertexArray},
};

void trim_end(std::string_view& text) {
    text.remove_suffix(text.size() - (text.find_last_not_of(" =(") + 1));
}

/// The label of the object with this number, if the words before the number say of what kind it is.
std::string label_of(const Functions& gl, std::string_view words_before, std::string_view number) {
    std::string lower(words_before);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::string_view words = lower;
    trim_end(words);
    if (words.ends_with(" object")) words.remove_suffix(std::string_view("object").size());
    trim_end(words);
    GLuint id = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), id).ec != std::errc{}) return {};
    const auto noun = std::ranges::find_if(nouns, [&](const Noun& one) { return words.ends_with(one.word); });
    if (noun == nouns.end() || (gl.*noun->exists)(id) == GL_FALSE) return {};
    std::array<GLchar, 256> label{};
    GLsizei length = 0;
    gl.GetObjectLabel(noun->identifier, id, static_cast<GLsizei>(label.size()), &length, label.data());
    return {label.data(), static_cast<std::size_t>(length)};
}

/// The message with the label after each object that it mentions by number: "program 3" to "program 3 'blend'".
std::string with_labels(const Functions& gl, std::string_view message) {
    constexpr std::string_view digits = "0123456789";
    std::string text;
    std::size_t end = 0;
    for (std::size_t begin; (begin = message.find_first_of(digits, end)) != message.npos;) {
        const std::size_t after = std::min(message.find_first_not_of(digits, begin), message.size());
        text += message.substr(end, after - end);
        end = after;
        const std::string label = label_of(gl, message.substr(0, begin), message.substr(begin, after - begin));
        if (!label.empty()) text += fmt::format(" '{}'", label);
    }
    return text.append(message.substr(end));
}

std::string error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_STACK_OVERFLOW:
            return "GL_STACK_OVERFLOW";
        case GL_STACK_UNDERFLOW:
            return "GL_STACK_UNDERFLOW";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return fmt::format("GL error {:#06x}", error);
    }
}

/// A driver may hold one flag per kind of error, and a lost context reports errors forever.
std::vector<std::string> take_errors(const Functions& gl) {
    std::vector<std::string> names;
    while (names.size() < max_kept) {
        const GLenum error = gl.GetError();
        if (error == GL_NO_ERROR) break;
        names.push_back(error_name(error));
    }
    return names;
}

spdlog::level::level_enum level_of(GLenum type, GLenum severity) {
    if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH) return spdlog::level::err;
    // Performance hints, and NVIDIA's hints of low severity, come with every frame; only those who look for them want
    // to see them.
    if (type == GL_DEBUG_TYPE_PERFORMANCE) return spdlog::level::debug;
    if (severity == GL_DEBUG_SEVERITY_MEDIUM) return spdlog::level::warn;
    return severity == GL_DEBUG_SEVERITY_LOW ? spdlog::level::debug : spdlog::level::trace;
}

}  // namespace

void DebugLog::attach(const Functions& gl) {
    gl.Enable(GL_DEBUG_OUTPUT);
    gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl.DebugMessageCallback(&DebugLog::on_message, this);
    gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
    // Notifications too, but these say where the others come from.
    for (GLenum type : {GL_DEBUG_TYPE_PUSH_GROUP, GL_DEBUG_TYPE_POP_GROUP}) {
        gl.DebugMessageControl(GL_DONT_CARE, type, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    }
}

void GLAD_API_PTR DebugLog::on_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                       const GLchar* message, const void* user) {
    const std::size_t size = length < 0 ? std::strlen(message) : static_cast<std::size_t>(length);
    // GL hands the pointer of attach() back as a pointer to const.
    auto* log = static_cast<DebugLog*>(const_cast<void*>(user));
    log->add(source, type, severity, {message, size});
}

void DebugLog::add(GLenum source, GLenum type, GLenum severity, std::string_view message) {
    if (type == GL_DEBUG_TYPE_PUSH_GROUP) {
        m_groups.emplace_back(message);
        return;
    }
    if (type == GL_DEBUG_TYPE_POP_GROUP) {
        if (!m_groups.empty()) m_groups.pop_back();
        return;
    }
    while (!message.empty() && (message.back() == '\n' || message.back() == '\0')) message.remove_suffix(1);
    std::string text = fmt::format("{}{}{}", fmt::join(m_groups, " / "), m_groups.empty() ? "" : ": ", message);
    const bool compiler = source == GL_DEBUG_SOURCE_SHADER_COMPILER;
    const auto level = compiler ? spdlog::level::debug : level_of(type, severity);
    spdlog::log(level, "{}: {}", m_name, text);
    if (level == spdlog::level::err && m_kept.size() < max_kept) m_kept.push_back(std::move(text));
}

void DebugLog::check(const Functions& gl, std::string_view where) {
    // The messages say more than the errors that go with them.
    std::vector<std::string> reasons = take_errors(gl);
    const bool lost = std::ranges::find(reasons, error_name(GL_CONTEXT_LOST)) != reasons.end() ||
                      (!reasons.empty() && gl.GetGraphicsResetStatus() != GL_NO_ERROR);
    if (!m_kept.empty()) reasons = std::exchange(m_kept, {});
    if (reasons.empty()) return;
    if (lost)
        throw ContextLost(
            fmt::format("{}: the device was reset and its context is lost: {}", where, fmt::join(reasons, "; ")));
    for (std::string& reason : reasons) reason = with_labels(gl, reason);
    throw RenderError(fmt::format("{}: {}", where, fmt::join(reasons, "; ")));
}

}  // namespace sheer::gl
