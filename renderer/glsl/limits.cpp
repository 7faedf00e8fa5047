#include "renderer/glsl/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "renderer/glsl/constants.h"

namespace sheer {

namespace {

constexpr std::size_t max_guarded_bytes = std::size_t{1} << 20;
constexpr int deepest_declaration = 64, deepest_division = 64;

/// How many numbers each built-in type holds that can be in an array.
std::map<std::string, std::int64_t, std::less<>> built_in_types() {
    std::map<std::string, std::int64_t, std::less<>> types = {
        {"float", 1}, {"int", 1}, {"uint", 1}, {"bool", 1}, {"double", 2}};
    for (int n = 2; n <= 4; ++n) {
        for (const std::string prefix : {"", "i", "u", "b", "d"})
            types[fmt::format("{}vec{}", prefix, n)] = prefix == "d" ? 2 * n : n;
        for (const std::string prefix : {"", "d"}) {
            types[fmt::format("{}mat{}", prefix, n)] = (prefix == "d" ? 2 : 1) * n * n;
            for (int m = 2; m <= 4; ++m)
                types[fmt::format("{}mat{}x{}", prefix, n, m)] = (prefix == "d" ? 2 : 1) * n * m;
        }
    }
    return types;
}

/// Words that may precede a name without being its type.
bool is_keyword(std::string_view word) {
    static const std::set<std::string_view> all = {
        "return", "else", "case", "do",    "const", "highp",  "mediump", "lowp",   "if",      "for",      "while",
        "switch", "in",   "out",  "inout", "flat",  "smooth", "precise", "struct", "default", "continue", "break"};
    return all.contains(word);
}

/// Finds what a function declares: its constants, and arrays, which must not be too large.
class Declarations {
  public:
    explicit Declarations(const std::vector<GlslToken>& tokens)
        : m_tokens(tokens), m_constants(tokens), m_in_size(tokens.size(), false) {
        scan(0, m_tokens.size());
    }

    const GlslConstants& constants() const { return m_constants; }
    /// Whether this token is within the brackets of an array's size.
    bool in_size(std::size_t token) const { return m_in_size[token]; }

  private:
    bool is(std::size_t token, std::string_view text) const {
        return token < m_tokens.size() && m_tokens[token].text == text;
    }
    bool is_identifier(std::size_t token) const {
        return token < m_tokens.size() && m_tokens[token].is_name() && !is_keyword(m_tokens[token].text);
    }

    /// Returns how many numbers all declarations there hold.
    std::int64_t scan(std::size_t begin, std::size_t end) {
        std::int64_t numbers = 0;
        if (++m_depth > deepest_declaration) throw GlslError(m_tokens[begin].line, "nests declarations too deeply");
        for (std::size_t i = begin; i < end;) {
            if (is(i, "struct")) {
                numbers += read_struct(i);
            } else if (const auto type = type_at(i)) {
                const bool constant = is_constant(i);
                const bool integer = is(i, "int") || is(i, "uint");
                numbers += read_declarators(++i, *type, constant && integer);
            } else {
                ++i;
            }
        }
        --m_depth;
        return numbers;
    }

    bool is_constant(std::size_t type) const {
        std::size_t before = type;
        while (before > 0 && (is(before - 1, "highp") || is(before - 1, "mediump") || is(before - 1, "lowp"))) --before;
        return before > 0 && is(before - 1, "const");
    }

    /// A type is followed by what it declares, or by the brackets of an array. Any name before another one counts as a
    /// type, since unknown types contain no arrays.
    std::optional<std::int64_t> type_at(std::size_t i) const {
        if (!is_identifier(i)) return std::nullopt;
        const auto known = m_types.find(m_tokens[i].text);
        if (known != m_types.end()) return known->second;
        if (is_identifier(i + 1)) return 1;
        return std::nullopt;
    }

    std::int64_t read_struct(std::size_t& i) {
        const std::size_t name = i + 1, open = is(name, "{") ? name : name + 1;
        if (!is(open, "{")) {
            ++i;
            return 0;
        }
        const std::size_t close = m_tokens[open].partner;
        const std::int64_t numbers = scan(open + 1, close);
        if (open != name) m_types[std::string(m_tokens[name].text)] = numbers;
        i = close + 1;
        return read_declarators(i, numbers, false);
    }

    /// From after the type to after the last declarator; for a constructor, to after the brackets.
    std::int64_t read_declarators(std::size_t& i, std::int64_t type_numbers, bool constant) {
        const std::size_t first = i;
        const std::int64_t type = type_numbers * read_sizes(i);
        if (!is_identifier(i)) return i > first ? check(type, m_tokens[first].line) : 0;
        std::int64_t numbers = 0;
        while (is_identifier(i)) {
            const std::size_t name = i++;
            const std::size_t brackets = i;
            const std::int64_t own = type * read_sizes(i);
            const bool is_array = i > brackets || type != type_numbers || type_numbers > 16;
            numbers += is_array ? check(own, m_tokens[name].line) : own;
            std::optional<std::int64_t> value;
            if (is(i, "=")) {
                const std::size_t end = end_of_initializer(i + 1);
                if (constant && !is_array) value = m_constants.value(i + 1, end);
                scan(i + 1, end);
                i = end;
            }
            m_constants.declare(std::string(m_tokens[name].text), value);
            if (!is(i, ",")) break;
            ++i;
        }
        return numbers;
    }

    /// The product of the sizes in brackets from here on, 1 for none. An empty pair has the length of the list after
    /// it.
    std::int64_t read_sizes(std::size_t& i) {
        std::int64_t product = 1;
        while (is(i, "[")) {
            const std::size_t close = m_tokens[i].partner;
            std::fill(m_in_size.begin() + static_cast<std::ptrdiff_t>(i),
                      m_in_size.begin() + static_cast<std::ptrdiff_t>(close), true);
            const auto size = close == i + 1 ? listed(close + 1) : m_constants.value(i + 1, close);
            if (!size)
                throw GlslError(m_tokens[i].line,
                                "has an array of unknown size; write the size as a whole number, or as a const int "
                                "that is set to one");
            product = std::min<std::int64_t>(product * std::clamp<std::int64_t>(*size, 0, max_array_numbers + 1),
                                             max_array_numbers + 1);
            i = close + 1;
        }
        return product;
    }

    /// How many values are listed in the brackets at `i`; 1 if there are none: the initializer has its own type.
    std::int64_t listed(std::size_t i) const {
        if (is(i, "=")) ++i;
        if (!is(i, "(") && !is(i, "{")) return 1;
        std::int64_t count = 1;
        for (std::size_t at = i + 1; at < m_tokens[i].partner; ++at) {
            if (m_tokens[at].partner > at) at = m_tokens[at].partner;
            if (is(at, ",")) ++count;
        }
        return count;
    }

    std::size_t end_of_initializer(std::size_t i) const {
        while (i < m_tokens.size() && !is(i, ",") && !is(i, ";")) {
            const char c = m_tokens[i].text[0];
            if (c == ')' || c == ']' || c == '}') break;
            i = m_tokens[i].partner > i ? m_tokens[i].partner + 1 : i + 1;
        }
        return i;
    }

    std::int64_t check(std::int64_t numbers, int line) {
        if (numbers > max_array_numbers)
            throw GlslError(line, fmt::format("has an array of more than {} numbers", max_array_numbers));
        m_together += numbers;
        if (m_together > max_array_numbers_together)
            throw GlslError(line,
                            fmt::format("has arrays of more than {} numbers in total", max_array_numbers_together));
        return numbers;
    }

    const std::vector<GlslToken>& m_tokens;
    GlslConstants m_constants;
    std::map<std::string, std::int64_t, std::less<>> m_types = built_in_types();
    std::vector<bool> m_in_size;  ///< by token
    std::int64_t m_together = 0;
    int m_depth = 0;
};

/// Rewrites the text with guarded divisions.
class DivisionGuard {
  public:
    DivisionGuard(const std::string& text, const std::vector<GlslToken>& tokens, const Declarations& declarations)
        : m_text(text), m_tokens(tokens), m_declarations(declarations) {}

    std::string run() {
        if (m_tokens.empty()) return m_text;
        return m_text.substr(0, m_tokens[0].begin) + range(0, m_tokens.size()) + m_text.substr(m_tokens.back().end());
    }

  private:
    bool is(std::size_t token, std::string_view text) const {
        return token < m_tokens.size() && m_tokens[token].text == text;
    }
    bool touches_next(std::size_t token) const {
        return token + 1 < m_tokens.size() && m_tokens[token].end() == m_tokens[token + 1].begin;
    }
    /// Two identical operators in a row, such as ++.
    bool is_twice(std::size_t token, std::string_view sign) const {
        return is(token, sign) && is(token + 1, sign) && touches_next(token);
    }
    bool divides(std::size_t token) const {
        return (is(token, "/") || is(token, "%")) && !m_declarations.in_size(token);
    }

    /// From the first of these tokens to the end of the last.
    std::string range(std::size_t begin, std::size_t end) {
        std::string result;
        std::size_t copied = m_tokens[begin].begin;
        const auto copy_to = [&](std::size_t to) {
            result += m_text.substr(copied, to - copied);
            copied = to;
        };
        for (std::size_t i = begin; i < end;) {
            std::size_t operand = 0, behind = 0;
            const bool assigns = divides(i) && is(i + 1, "=") && touches_next(i);
            if (divides(i)) {
                operand = i + (assigns ? 2 : 1);
                behind = std::min(assigns ? end_of_assignment(operand) : end_of_unary(operand), end);
            }
            if (behind <= operand || is_harmless(i, operand, behind, assigns)) {
                ++i;
                continue;
            }
            copy_to(m_tokens[i].begin);
            result += guarded(i, operand, behind, assigns);
            copied = m_tokens[behind - 1].end();
            i = behind;
        }
        copy_to(m_tokens[end - 1].end());
        if (result.size() > max_guarded_bytes) throw GlslError(m_tokens[begin].line, "nests divisions too deeply");
        return result;
    }

    /// The replacement for an operator and its right side.
    std::string guarded(std::size_t op, std::size_t operand, std::size_t behind, bool assigns) {
        check_no_side_effects(operand, behind);
        if (++m_depth > deepest_division) throw GlslError(m_tokens[op].line, "nests divisions too deeply");
        const std::string by = range(operand, behind);
        --m_depth;
        std::string once_more = by;
        std::ranges::replace(once_more, '\n', ' ');  // lines stay where they are
        const std::size_t op_end = m_tokens[op].end() + (assigns ? 1 : 0);
        const std::string gap = m_text.substr(op_end, m_tokens[operand].begin - op_end);  // may be a new line
        const std::string begin = (assigns ? "= " + left_side(op) + " *" : "*") + gap;
        return fmt::format("{}sheer_sign({}) {} sheer_magnitude({})", begin, by, m_tokens[op].text, once_more);
    }

    /// A positive literal needs no guard. Throws if the division is known to have no result.
    bool is_harmless(std::size_t op, std::size_t operand, std::size_t behind, bool assigns) const {
        const auto by = m_declarations.constants().value(operand, behind);
        if (by == 0) throw GlslError(m_tokens[op].line, "divides by 0");
        if (by == -1 && !assigns && left_value(op) == std::numeric_limits<std::int32_t>::min())
            throw GlslError(m_tokens[op].line, "divides the least integer by -1, which has no result in 32 bits");
        const bool literal = m_tokens[operand].is_number() || is(operand, ".");
        return literal && (!assigns || behind == operand + 1);
    }

    /// The value of the unary expression before the operator, as a signed 32-bit integer.
    std::optional<std::int64_t> left_value(std::size_t op) const {
        if (op == 0) return std::nullopt;
        std::size_t begin = op - 1;
        if (is(begin, ")")) begin = m_tokens[begin].partner;
        if (begin > 0 && (is(begin - 1, "int") || is(begin - 1, "uint"))) --begin;
        if (begin > 0 && m_tokens[begin - 1].is_name() && !is_keyword(m_tokens[begin - 1].text)) return std::nullopt;
        const bool minus = begin > 0 && is(begin - 1, "-") && (begin == 1 || !ends_operand(begin - 2));
        const auto value = m_declarations.constants().value(minus ? begin - 1 : begin, op);
        if (!value) return std::nullopt;
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(*value)));
    }

    bool ends_operand(std::size_t token) const {
        return is(token, ")") || is(token, "]") || m_tokens[token].is_number() ||
               (m_tokens[token].is_name() && !is_keyword(m_tokens[token].text));
    }

    /// The token after the unary expression that begins at `i`; `i` itself if none does.
    std::size_t end_of_unary(std::size_t i) const {
        std::size_t at = i;
        while (is(at, "-") || is(at, "+") || is(at, "!") || is(at, "~")) ++at;
        if (at >= m_tokens.size()) return i;
        if (is(at, ".")) ++at;
        if (at >= m_tokens.size()) return i;
        const GlslToken& token = m_tokens[at];
        if (token.is_number()) {
            const bool hexadecimal = token.text.starts_with("0x") || token.text.starts_with("0X");
            const bool cut = !hexadecimal && (token.text.ends_with('e') || token.text.ends_with('E'));
            return std::min(at + (cut ? 3 : 1), m_tokens.size());
        }
        if (!token.is_name() && token.text != "(") return i;
        at = token.text == "(" ? token.partner + 1 : at + 1;
        return end_of_postfix(at);
    }

    std::size_t end_of_postfix(std::size_t at) const {
        for (;;) {
            if (is(at, "(") || is(at, "[")) {
                at = m_tokens[at].partner + 1;
            } else if (is(at, ".") || is_twice(at, "+") || is_twice(at, "-")) {
                at += 2;
            } else {
                return std::min(at, m_tokens.size());
            }
        }
    }

    std::size_t end_of_assignment(std::size_t i) const {
        int choices = 0;
        while (i < m_tokens.size()) {
            const char c = m_tokens[i].text[0];
            if (c == '?') ++choices;
            const bool ends = c == ',' || c == ';' || c == ')' || c == ']' || c == '}' || (c == ':' && choices-- == 0);
            if (ends) break;
            i = m_tokens[i].partner > i ? m_tokens[i].partner + 1 : i + 1;
        }
        return i;
    }

    /// The variable before a /=; it is written twice.
    std::string left_side(std::size_t op) {
        std::size_t begin = op;
        while (begin > 0) {
            if (is(begin - 1, "]")) {
                begin = m_tokens[begin - 1].partner;
            } else if (m_tokens[begin - 1].is_name() && begin > 1 && is(begin - 2, ".")) {
                begin -= 2;
            } else {
                --begin;
                break;
            }
        }
        if (begin == op || !m_tokens[begin].is_name())
            throw GlslError(m_tokens[op].line,
                            fmt::format("has a {}= after something that is not a variable", m_tokens[op].text));
        check_no_side_effects(begin, op);
        std::string left = range(begin, op);
        std::ranges::replace(left, '\n', ' ');
        return left;
    }

    /// Expressions that are written twice must not have side effects.
    void check_no_side_effects(std::size_t begin, std::size_t end) const {
        constexpr std::string_view comparing = "=<>!";
        for (std::size_t i = begin; i < end; ++i) {
            const bool before =
                i > begin && touches_next(i - 1) && comparing.find(m_tokens[i - 1].text[0]) != comparing.npos;
            const bool compares = before || is_twice(i, "=");
            if (is_twice(i, "+") || is_twice(i, "-") || (is(i, "=") && !compares))
                throw GlslError(m_tokens[i].line,
                                "changes a variable within a division, which is not supported; do it "
                                "in an earlier statement");
        }
    }

    const std::string& m_text;
    const std::vector<GlslToken>& m_tokens;
    const Declarations& m_declarations;
    int m_depth = 0;
};

/// Compilers traverse an expression recursively: one of 30,000 terms overflows the stack of Mesa's compiler.
void check_statements(const std::vector<GlslToken>& tokens) {
    std::size_t length = 0;
    for (const GlslToken& token : tokens) {
        length = token.text == ";" || token.text == "{" || token.text == "}" ? 0 : length + 1;
        if (length > max_statement_tokens)
            throw GlslError(token.line,
                            fmt::format("has a statement of more than {} tokens; split it", max_statement_tokens));
    }
}

}  // namespace

std::string guard_glsl(const std::string& text) {
    const std::vector<GlslToken> tokens = read_glsl_tokens(text);
    check_statements(tokens);
    const Declarations declarations(tokens);
    return DivisionGuard(text, tokens, declarations).run();
}

}  // namespace sheer
