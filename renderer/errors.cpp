#include "renderer/errors.h"

#include <fmt/format.h>

namespace sheer {

namespace {

std::string joined(const std::vector<FieldError>& errors) {
    std::string text;
    for (const auto& error : errors) {
        if (!text.empty()) text += '\n';
        text += error.pointer.empty() ? error.detail : fmt::format("{}: {}", error.pointer, error.detail);
    }
    return text;
}

}  // namespace

SpecError::SpecError(std::vector<FieldError> errors)
    : std::runtime_error(joined(errors)), m_errors(std::move(errors)) {}

}  // namespace sheer
