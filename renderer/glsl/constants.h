#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/glsl/tokens.h"

namespace sheer {

/// The constant integers of a function: `const int` and `const uint` that are set to a constant expression.
class GlslConstants {
  public:
    explicit GlslConstants(const std::vector<GlslToken>& tokens) : m_tokens(tokens) {}

    /// The value of the tokens from `begin` to before `end`: literals, constants, + - * / % << >>, parentheses, int()
    /// and uint(). Nothing if they are anything else. Values beyond 10^12 are clamped.
    std::optional<std::int64_t> value(std::size_t begin, std::size_t end) const;
    /// The declared name has this value; nothing for a variable. A name that is declared twice is not a constant.
    void declare(const std::string& name, std::optional<std::int64_t> value);

  private:
    const std::vector<GlslToken>& m_tokens;
    std::map<std::string, std::optional<std::int64_t>, std::less<>> m_values;
};

/// The value of an integer literal: decimal, octal or hexadecimal, with or without u. Nothing for a float.
std::optional<std::int64_t> glsl_integer(std::string_view literal);

}  // namespace sheer
