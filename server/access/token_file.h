#pragma once
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/access/token.h"

namespace sheer {

/// The file of tokens cannot be read, or a change of it is refused. The text is a message for people.
class TokenError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The tokens of a service, as a JSON file that only its owner may read. Several processes may use it at once: a
/// change replaces it as a whole.
class TokenFile {
  public:
    explicit TokenFile(std::filesystem::path path) : m_path(std::move(path)) {}

    const std::filesystem::path& path() const { return m_path; }
    /// None if there is no such file. Throws TokenError if it cannot be read or is not what create() wrote.
    std::vector<Token> read() const;
    /// Adds a token and returns its secret. Throws TokenError if the name is taken or has other characters than
    /// is_token_name() allows.
    std::string create(const std::string& name, Scope scope, const Quota& quota, std::int64_t now_ms);
    /// Throws TokenError if there is no such token.
    void revoke(const std::string& name);

  private:
    void change(const std::function<void(std::vector<Token>&)>& edit);

    std::filesystem::path m_path;
};

}  // namespace sheer
