#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

/// The text cannot be the body of a function; names the line and what is wrong with it.
class GlslError : public std::runtime_error {
  public:
    GlslError(int line, const std::string& detail);
};

/// A token of GLSL without comments and directives. `text` points into the text from which it was read.
struct GlslToken {
    std::string_view text;
    std::size_t begin;
    int line;
    std::size_t partner = 0;  ///< of a bracket: the token that closes or opens it
    std::size_t end() const { return begin + text.size(); }
    bool is_number() const;
    bool is_name() const;
};

/// Names, numbers, and single characters of anything else, with matching brackets. Letters within a number are not
/// names. Throws GlslError for unmatched brackets.
std::vector<GlslToken> read_glsl_tokens(std::string_view text);

/// Replaces `length` bytes of a text from `begin` on.
struct TextEdit {
    std::size_t begin, length;
    std::string text;
};
/// `text` with all edits, which must not overlap; at the same place, the earlier one comes first.
std::string edited(const std::string& text, std::vector<TextEdit> edits);

}  // namespace sheer
