#include "renderer/glsl/own_shading.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "renderer/glsl/limits.h"

namespace sheer {

namespace {

/// Added to the user's line numbers, so that they can be recognized in a driver's log. (Mesa ignores the source string
/// number of #line, which is meant for that.)
constexpr int first_user_line = 100000;
constexpr std::size_t max_messages = 10;

/// \r\n, \r and \n each end a line; here they all become \n.
std::string checked_text(const std::string& body) {
    std::string text;
    int line = 1;
    for (std::size_t i = 0; i < body.size(); ++i) {
        const char c = body[i];
        if (c == '\n' && i > 0 && body[i - 1] == '\r') continue;
        const bool ends_line = c == '\n' || c == '\r';
        if (!ends_line && c != '\t' && (c < ' ' || c > '~'))
            throw GlslError(line, fmt::format("has the byte {:#04x}; only printable ASCII is allowed",
                                              static_cast<unsigned char>(c)));
        text += ends_line ? '\n' : c;
        if (ends_line) ++line;
    }
    return text;
}

/// The same lines without comments, so that later steps need not handle them.
class CommentRemover {
  public:
    explicit CommentRemover(const std::string& text) : m_text(text) {}

    std::string run() {
        while (m_at < m_text.size()) {
            if (starts("//")) {
                m_at = std::min(m_text.find('\n', m_at), m_text.size());
            } else if (starts("/*")) {
                skip_block();
            } else {
                copy();
            }
        }
        return std::move(m_result);
    }

  private:
    bool starts(std::string_view part) const { return m_text.compare(m_at, part.size(), part) == 0; }

    void skip_block() {
        const std::size_t end = m_text.find("*/", m_at + 2);
        if (end == std::string::npos) throw GlslError(m_line, "begins a comment that is not closed");
        const auto lines = std::count(m_text.begin() + static_cast<std::ptrdiff_t>(m_at),
                                      m_text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
        m_result += ' ' + std::string(static_cast<std::size_t>(lines), '\n');
        m_line += static_cast<int>(lines);
        m_at = end + 2;
    }

    void copy() {
        const char c = m_text[m_at++];
        if (c == '#') throw GlslError(m_line, "has a #; directives are not allowed in the body of a function");
        if (c == '\\' || c == '"' || c == '\'')
            throw GlslError(m_line, fmt::format("has a {}, which GLSL does not use", c));
        if (c == '\n') ++m_line;
        m_result += c;
    }

    const std::string& m_text;
    std::size_t m_at = 0;
    int m_line = 1;
    std::string m_result;
};

/// The samples of a pixel and the number of a fragment's primitive depend on how a method draws.
bool is_same_for_all(std::string_view built_in) {
    return built_in == "gl_FragCoord" || built_in == "gl_FrontFacing" || built_in.starts_with("gl_Max") ||
           built_in.starts_with("gl_Min");
}

/// Names that would break the rules: methods decide what happens to a fragment, and the counter counts it.
void check_name(const GlslToken& token) {
    struct Refused {
        std::string_view name, why;
    };
    static constexpr std::array<Refused, 7> refused = {{
        {"discard", "is left to the methods; return an alpha of 0 instead"},
        {"gl_FragDepth", "is left to the methods"},
        {"interpolateAtSample", "means something else for each number of samples"},
        {"interpolateAtCentroid", "means something else for each number of samples"},
        {"interpolateAtOffset", "means something else for each number of samples"},
        {"begin_fragment", "is called before the function"},
        {"real_work", "is this function, and GLSL has no recursion"},
    }};
    const auto* found = std::ranges::find(refused, token.text, &Refused::name);
    if (found != refused.end()) throw GlslError(token.line, fmt::format("has {}, which {}", token.text, found->why));
    if (token.text.starts_with("gl_") && !is_same_for_all(token.text))
        throw GlslError(token.line, fmt::format("has {}, which is not the same for every method; gl_FragCoord and "
                                                "gl_FrontFacing may be read",
                                                token.text));
    if (token.text.starts_with("sheer_") || token.text.starts_with("SHEER_"))
        throw GlslError(token.line, fmt::format("has {}; names with this prefix are reserved", token.text));
}

/// Reading a texture without a level takes them too.
bool takes_derivatives(std::string_view function) {
    static constexpr std::array<std::string_view, 8> others = {
        "fwidth",        "fwidthFine",  "fwidthCoarse",      "texture",
        "textureOffset", "textureProj", "textureProjOffset", "textureQueryLod"};
    return function.starts_with("dFd") || std::ranges::find(others, function) != others.end();
}

/// Appends `&& sheer_next()` to the condition of every loop.
class LoopCounter {
  public:
    LoopCounter(std::string text, std::vector<GlslToken> tokens)
        : m_text(std::move(text)), m_tokens(std::move(tokens)) {}

    std::string run() {
        for (std::size_t i = 0; i < m_tokens.size(); ++i) {
            if (m_tokens[i].text == "for") count_for(i);
            if (m_tokens[i].text == "while") count_condition(i, parenthesis(i), m_tokens[parenthesis(i)].partner);
        }
        return edited(m_text, std::move(m_edits));
    }

  private:
    std::size_t parenthesis(std::size_t loop) const {
        if (loop + 1 < m_tokens.size() && m_tokens[loop + 1].text == "(") return loop + 1;
        throw GlslError(m_tokens[loop].line, fmt::format("has a {} without (", m_tokens[loop].text));
    }

    void count_for(std::size_t loop) {
        const std::size_t open = parenthesis(loop), close = m_tokens[open].partner;
        std::vector<std::size_t> semicolons;
        for (std::size_t i = open + 1; i < close; ++i) {
            if (m_tokens[i].partner > i) i = m_tokens[i].partner;
            if (m_tokens[i].text == ";") semicolons.push_back(i);
        }
        if (semicolons.size() != 2) throw GlslError(m_tokens[loop].line, "has a for without two semicolons");
        count_condition(loop, semicolons[0], semicolons[1]);
    }

    /// The condition is between these two tokens.
    void count_condition(std::size_t loop, std::size_t before, std::size_t after) {
        if (before + 2 < after && m_tokens[before + 1].is_name() && m_tokens[before + 2].is_name())
            throw GlslError(
                m_tokens[loop].line,
                "declares a variable in the condition of a loop, which is not supported; declare it earlier");
        const bool always = after == before + 1 && m_tokens[before].text == ";";
        insert(m_tokens[before].begin + 1, always ? "sheer_next()" : "(");
        insert(m_tokens[after].begin, always ? "" : ") && sheer_next()");
    }

    void insert(std::size_t at, std::string text) { m_edits.push_back({at, 0, std::move(text)}); }

    std::string m_text;
    std::vector<GlslToken> m_tokens;  ///< of the text that `m_text` is a copy of
    std::vector<TextEdit> m_edits;
};

/// What a driver says about line `line` of the user's function; false if the log line is about something else.
bool read_log_line(const std::string& text, int& line, std::string& message) {
    int source = 0, column = 0, length = 0;
    const auto is = [&](int fields, int wanted) { return fields == wanted && length > 0 && line >= first_user_line; };
    const char* begin = text.c_str();
    const bool found = is(std::sscanf(begin, "%d:%d(%d): %n", &source, &line, &column, &length), 3) ||  // Mesa
                       is(std::sscanf(begin, "%d(%d) : %n", &source, &line, &length), 2) ||             // NVIDIA
                       is(std::sscanf(begin, "ERROR: %d:%d: %n", &source, &line, &length), 2);          // AMD
    if (!found) return false;
    line -= first_user_line - 1;
    message = text.substr(static_cast<std::size_t>(length));
    const std::size_t name = message.find("sheer_own_work");
    if (name != std::string::npos) message.replace(name, std::string_view("sheer_own_work").size(), "real_work");
    return true;
}

}  // namespace

GlslShading make_glsl_shading(const std::string& body) {
    const std::string uncommented = CommentRemover(checked_text(body)).run();
    GlslShading shading;
    for (const GlslToken& token : read_glsl_tokens(uncommented)) {
        check_name(token);
        shading.has_loops |= token.text == "for" || token.text == "while";
        shading.is_textured |= token.text == "sample_texture";
        shading.takes_derivatives |= takes_derivatives(token.text);
    }
    const std::string text = guard_glsl(uncommented);
    // On the user's own lines, so that no error can be before the first or after the last one.
    shading.function = fmt::format("#line {}\nvec4 sheer_own_work(vec2 uv, vec4 tint) {{ {} }}\n#line 1\n",
                                   first_user_line, LoopCounter(text, read_glsl_tokens(text)).run());
    return shading;
}

void check_glsl_shading(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors) {
    const nlohmann::json& shading = scene.at("shading");
    if (!shading.is_object() || !shading.at("glsl").is_string()) return;
    try {
        make_glsl_shading(shading.at("glsl"));
    } catch (const GlslError& error) {
        errors.push_back({pointer + "/shading/glsl", error.what()});
    }
}

std::string user_messages(const std::string& driver_log) {
    std::istringstream log(driver_log);
    std::string text, message, messages;
    std::size_t count = 0;
    for (int line = 0; std::getline(log, text);) {
        if (!read_log_line(text, line, message) || message.starts_with("warning")) continue;
        if (message.starts_with("error: ")) message = message.substr(7);
        if (count++ < max_messages)
            messages += fmt::format("{}line {}: {}", messages.empty() ? "" : "\n", line, message);
    }
    return messages;
}

}  // namespace sheer
