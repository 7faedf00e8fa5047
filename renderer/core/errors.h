#pragma once
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace sheer {

/// One wrong field of a spec.
struct FieldError {
    std::string pointer;  ///< JSON pointer (RFC 6901) to the field, "" for the whole document
    std::string detail;   ///< what is wrong and what would be right
};

/// At most this many wrong fields are listed; the others are only counted.
inline constexpr std::size_t max_told_errors = 100;

/// Adds an error to `errors`. `detail` makes its text and is not called for errors that are only counted, so a mistake
/// in a hundred thousand places does not cost a hundred thousand texts.
template <typename Detail>
void add_error(std::vector<FieldError>& errors, std::string pointer, const Detail& detail) {
    errors.push_back({std::move(pointer), errors.size() < max_told_errors ? detail() : std::string()});
}

/// A mistake of the caller's, with every wrong field. HTTP 422, exit code 2.
class SpecError : public std::runtime_error {
  public:
    explicit SpecError(std::vector<FieldError> errors);
    /// The first max_told_errors of them.
    const std::vector<FieldError>& errors() const { return m_errors; }
    /// The number of all errors.
    std::size_t count() const { return m_count; }

  private:
    std::size_t m_count;
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

/// A file could not be written. The same comparison may succeed once the disk has space again.
class WriteError : public std::system_error {
  public:
    WriteError(int error_number, const std::string& path)
        : std::system_error(error_number, std::generic_category(), "cannot write " + path) {}
    bool is_full() const { return code() == std::errc::no_space_on_device; }
};

/// The device or its driver was reset (GL_CONTEXT_LOST): nothing more can be rendered on this context.
class ContextLost : public RenderError {
    using RenderError::RenderError;
};

}  // namespace sheer
