#include "renderer/glsl/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace sheer {

namespace {

bool is_name_part(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::vector<GlslToken> split(std::string_view text) {
    std::vector<GlslToken> tokens;
    int line = 1;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == '\n') ++line;
        if (text[at] == ' ' || text[at] == '\t' || text[at] == '\n') {
            ++at;
            continue;
        }
        std::size_t end = at + 1;
        const bool number = is_digit(text[at]);
        while (is_name_part(text[at]) && end < text.size() && (is_name_part(text[end]) || (number && text[end] == '.')))
            ++end;
        tokens.push_back({text.substr(at, end - at), at, line});
        at = end;
    }
    return tokens;
}

void pair_brackets(std::vector<GlslToken>& tokens) {
    constexpr std::string_view opening = "([{", closing = ")]}";
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const char c = tokens[i].text[0];
        if (opening.find(c) != std::string_view::npos) open.push_back(i);
        const std::size_t kind = closing.find(c);
        if (kind == std::string_view::npos) continue;
        if (open.empty()) throw GlslError(tokens[i].line, fmt::format("has a {} that closes nothing", c));
        if (tokens[open.back()].text[0] != opening[kind])
            throw GlslError(tokens[i].line, fmt::format("has a {} but the {} of line {} is still open", c,
                                                        tokens[open.back()].text, tokens[open.back()].line));
        tokens[i].partner = open.back();
        tokens[open.back()].partner = i;
        open.pop_back();
    }
    if (!open.empty())
        throw GlslError(tokens[open.back()].line, fmt::format("has a {} that is not closed", tokens[open.back()].text));
}

}  // namespace

GlslError::GlslError(int line, const std::string& detail)
    : std::runtime_error(fmt::format("line {} {}", line, detail)) {}

bool GlslToken::is_number() const {
    return is_digit(text[0]);
}

bool GlslToken::is_name() const {
    return is_name_part(text[0]) && !is_number();
}

std::vector<GlslToken> read_glsl_tokens(std::string_view text) {
    std::vector<GlslToken> tokens = split(text);
    pair_brackets(tokens);
    return tokens;
}

std::string edited(const std::string& text, std::vector<TextEdit> edits) {
    std::ranges::stable_sort(edits, {}, &TextEdit::begin);
    std::string result;
    std::size_t copied = 0;
    for (const TextEdit& edit : edits) {
        result += text.substr(copied, edit.begin - copied) + edit.text;
        copied = edit.begin + edit.length;
    }
    return result + text.substr(copied);
}

}  // namespace sheer
