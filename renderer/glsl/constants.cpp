#include "renderer/glsl/constants.h"

#include <algorithm>
#include <charconv>

namespace sheer {

namespace {

using GlslValue = std::optional<std::int64_t>;

/// So that no sum of two overflows 64 bits.
constexpr std::int64_t greatest_value = 1'000'000'000'000;
constexpr int deepest_nesting = 64;

std::int64_t cut(std::int64_t value) {
    return std::clamp(value, -greatest_value, greatest_value);
}

std::int64_t cut_product(std::int64_t a, std::int64_t b) {
    std::int64_t product = 0;
    if (__builtin_mul_overflow(a, b, &product)) return (a < 0) == (b < 0) ? greatest_value : -greatest_value;
    return cut(product);
}

/// By recursive descent, with a function for each level of precedence.
class Evaluator {
  public:
    using Names = std::map<std::string, GlslValue, std::less<>>;
    Evaluator(const std::vector<GlslToken>& tokens, const Names& names, std::size_t begin, std::size_t end)
        : m_tokens(tokens), m_names(names), m_at(begin), m_end(end) {}

    GlslValue run() {
        const GlslValue value = shift();
        return m_at == m_end ? value : std::nullopt;
    }

  private:
    bool is(std::string_view text, std::size_t ahead = 0) const {
        return m_at + ahead < m_end && m_tokens[m_at + ahead].text == text;
    }

    GlslValue shift() {
        GlslValue value = sum();
        while (value && ((is("<") && is("<", 1)) || (is(">") && is(">", 1)))) {
            const bool left = is("<");
            m_at += 2;
            const GlslValue by = sum();
            if (!by || *by < 0 || *by > 31) return std::nullopt;
            value = left ? cut_product(*value, std::int64_t{1} << *by) : *value >> *by;
        }
        return value;
    }

    GlslValue sum() {
        GlslValue value = product();
        while (value && (is("+") || is("-"))) {
            const bool plus = is("+");
            ++m_at;
            const GlslValue other = product();
            if (!other) return std::nullopt;
            value = cut(plus ? *value + *other : *value - *other);
        }
        return value;
    }

    GlslValue product() {
        GlslValue value = unary();
        while (value && (is("*") || is("/") || is("%"))) {
            const char operation = m_tokens[m_at++].text[0];
            const GlslValue other = unary();
            if (!other || (operation != '*' && *other == 0)) return std::nullopt;
            value = operation == '*'   ? cut_product(*value, *other)
                    : operation == '/' ? *value / *other
                                       : *value % *other;
        }
        return value;
    }

    GlslValue unary() {
        if (m_depth++ > deepest_nesting) return std::nullopt;
        GlslValue value;
        if (is("-") || is("+")) {
            const bool minus = is("-");
            ++m_at;
            value = unary();
            if (value && minus) value = -*value;
        } else {
            value = primary();
        }
        --m_depth;
        return value;
    }

    GlslValue primary() {
        if (m_at >= m_end) return std::nullopt;
        const GlslToken& token = m_tokens[m_at];
        if ((token.text == "int" || token.text == "uint") && is("(", 1)) ++m_at;
        if (is("(")) {
            ++m_at;
            const GlslValue value = shift();
            if (!is(")")) return std::nullopt;
            ++m_at;
            return value;
        }
        ++m_at;
        if (token.is_number()) return glsl_integer(token.text);
        const auto known = m_names.find(token.text);
        return known == m_names.end() ? std::nullopt : known->second;
    }

    const std::vector<GlslToken>& m_tokens;
    const Names& m_names;
    std::size_t m_at, m_end;
    int m_depth = 0;
};

}  // namespace

GlslValue glsl_integer(std::string_view literal) {
    if (literal.ends_with('u') || literal.ends_with('U')) literal.remove_suffix(1);
    int base = 10;
    if (literal.starts_with("0x") || literal.starts_with("0X")) {
        base = 16;
        literal.remove_prefix(2);
    } else if (literal.size() > 1 && literal[0] == '0') {
        base = 8;
    }
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(literal.data(), literal.data() + literal.size(), value, base);
    if (end != literal.data() + literal.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range) return greatest_value;
    if (error != std::errc()) return std::nullopt;
    return cut(value);
}

GlslValue GlslConstants::value(std::size_t begin, std::size_t end) const {
    return Evaluator(m_tokens, m_values, begin, end).run();
}

void GlslConstants::declare(const std::string& name, GlslValue value) {
    const bool is_new = m_values.emplace(name, value).second;
    if (!is_new) m_values[name] = std::nullopt;
}

}  // namespace sheer
