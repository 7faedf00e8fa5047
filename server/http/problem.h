#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/core/errors.h"
#include "server/http/message.h"

namespace sheer::http {

/// An error as an RFC 9457 problem+json answer. `errors` names wrong fields of the body by JSON pointer, at most
/// max_told_errors of them; `error_count` says how many there are. `allow` lists what a diff could allow.
Response problem(int status, const std::string& detail, const std::vector<FieldError>& errors = {},
                 std::size_t error_count = 0, const std::vector<std::string>& allow = {});

/// Ends a handler with a problem.
class Problem : public std::runtime_error {
  public:
    Problem(int status, const std::string& detail, std::vector<FieldError> errors = {})
        : std::runtime_error(detail), m_status(status), m_errors(std::move(errors)) {}
    Problem with(std::string header, std::string value) && {
        m_headers.emplace_back(std::move(header), std::move(value));
        return std::move(*this);
    }
    /// What a diff could allow.
    Problem with_allowable(std::vector<std::string> allow) && {
        m_allow = std::move(allow);
        return std::move(*this);
    }
    Response response() const;

  private:
    int m_status;
    std::vector<FieldError> m_errors;
    std::vector<std::pair<std::string, std::string>> m_headers;
    std::vector<std::string> m_allow;
};

/// "Not Found" and the like.
const char* status_phrase(int status);

}  // namespace sheer::http
