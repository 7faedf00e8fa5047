#include "renderer/core/errors.h"

#include <fmt/format.h>

namespace sheer {

namespace {

std::string joined(const std::vector<FieldError>& errors) {
    std::string text;
    for (std::size_t i = 0; i < errors.size() && i < max_told_errors; ++i) {
        const FieldError& error = errors[i];
        if (!text.empty()) text += '\n';
        text += error.pointer.empty() ? error.detail : fmt::format("{}: {}", error.pointer, error.detail);
    }
    if (errors.size() > max_told_errors) text += fmt::format("\nand {} more", errors.size() - max_told_errors);
    return text;
}

}  // namespace

SpecError::SpecError(std::vector<FieldError> errors)
    : std::runtime_error(joined(errors)), m_count(errors.size()), m_errors(std::move(errors)) {
    if (m_errors.size() > max_told_errors) m_errors.resize(max_told_errors);
}

}  // namespace sheer
