#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace sheer {

/// One wrong field of a spec.
struct FieldError {
    std::string pointer;  ///< JSON pointer (RFC 6901) to the field, "" for the whole document
    std::string detail;   ///< what is wrong and what would be right
};

/// The caller's mistake: every wrong field at once. HTTP 422, exit code 2.
class SpecError : public std::runtime_error {
  public:
    explicit SpecError(std::vector<FieldError> errors);
    const std::vector<FieldError>& errors() const { return m_errors; }

  private:
    std::vector<FieldError> m_errors;
};

/// This device or driver cannot do what was asked. Reported as `status: unsupported` with this reason.
class Unsupported : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Rendering failed: a shader that does not compile, a GL error of high severity, memory that ran out. Exit code 3.
class RenderError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The caller asked to stop.
class Cancelled : public std::runtime_error {
  public:
    Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace sheer
