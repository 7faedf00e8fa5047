#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheer::postgres {

/// Whether a text is meant as the URL of a PostgreSQL store.
bool is_postgres_url(std::string_view text);

/// Where a database is, and how to get in. Its password appears in no message.
class Address {
  public:
    /// `url`: postgresql://USER@HOST:PORT/DATABASE?PARAMETER=VALUE, as libpq reads it; what it leaves out comes from
    /// libpq's environment variables and ~/.pgpass. Throws StoreError, whose message does not repeat the URL.
    explicit Address(const std::string& url);

    /// The parameters for libpq, by name.
    const std::vector<std::pair<std::string, std::string>>& parameters() const { return m_parameters; }
    /// For people: host, port and database.
    const std::string& text() const { return m_text; }
    /// `message` in one line, with "***" for the password wherever it occurs.
    std::string without_password(std::string message) const;

  private:
    std::string value_of(std::string_view name) const;

    std::vector<std::pair<std::string, std::string>> m_parameters;
    std::string m_text;
};

}  // namespace sheer::postgres
