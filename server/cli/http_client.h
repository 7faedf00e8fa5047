#pragma once
#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheer::cli {

/// The server cannot be reached, or broke off.
class Unreachable : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An answer of any status.
struct HttpAnswer {
    int status = 0;
    std::map<std::string, std::string> headers;  ///< names in lower case
    std::string body;

    /// "" if there is none; `name` in lower case.
    std::string header(const std::string& name) const;
};

using HttpFields = std::vector<std::pair<std::string, std::string>>;

/// Requests to one service, each on a connection of its own, so that none depends on the one before.
class HttpClient {
  public:
    /// `url` is http://HOST[:PORT][/PATH]; the targets of requests are appended to PATH. `token` is sent as a bearer
    /// token if it is not "". Throws UsageError for any other URL.
    explicit HttpClient(std::string_view url, std::string token = "");

    /// Throws Unreachable, also if nothing arrives for `limit`.
    HttpAnswer request(const std::string& method, const std::string& target, const std::string& body = "",
                       const HttpFields& fields = {}, std::chrono::seconds limit = std::chrono::seconds(60)) const;
    const std::string& url() const { return m_url; }

  private:
    std::string m_url, m_host, m_port, m_path, m_token;
};

}  // namespace sheer::cli
