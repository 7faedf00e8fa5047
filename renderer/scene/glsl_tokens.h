#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

/// The text cannot be the body of a function; says the line and what is wrong with it.
class GlslError : public std::runtime_error {
  public:
    GlslError(int line, const std::string& detail);
};

/// Of GLSL without comments and directives. `text` lies in the text that it was read from.
struct GlslToken {
    std::string_view text;
    std::size_t begin;
    int line;
    std::size_t partner = 0;  ///< of a bracket: the token that closes or opens it
    std::size_t end() const { return begin + text.size(); }
    bool is_number() const;
    bool is_name() const;
};

/// Names, numbers, and single characters of anything else, with brackets in pairs. The letters within a number are no
/// names. Throws GlslError for brackets that are not paired.
std::vector<GlslToken> read_glsl_tokens(std::string_view text);

/// In place of `length` bytes of a text from `begin`.
struct TextEdit {
    std::size_t begin, length;
    std::string text;
};
/// `text` with all edits, which do not overlap; of those at one place the earlier comes first.
std::string edited(const std::string& text, std::vector<TextEdit> edits);

}  // namespace sheer
