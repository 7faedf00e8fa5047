#pragma once
#include <optional>
#include <set>
#include <string>

#include "server/http/message.h"

namespace sheer::http {

/// Keeps web pages from other sites from using a service that trusts everyone who can reach its port.
struct Guard {
    /// Names that a request may have in Host; empty allows any. A page whose name was made to point at this machine
    /// (DNS rebinding) sends its own name.
    std::set<std::string> hosts;
    /// Origins such as "https://ci.example", whose pages may read and change things here as the own page does.
    std::set<std::string> origins;
    /// The problem, or nothing if the request may go on.
    std::optional<Response> refusal(const Request& request) const;
    /// Adds what tells a browser whether the page that asks may read the answer (Fetch, 3.2).
    void permit(const Request& request, Headers& headers) const;

  private:
    bool is_friend(const Request& request) const;
};

/// On loopback, only the names of loopback and those in `allowed`; otherwise those in `allowed` and loopback, or any if
/// `allowed` is empty.
Guard make_guard(bool on_loopback, std::set<std::string> allowed, std::set<std::string> origins = {});

/// What is wrong with an origin of the configuration, to be read after it; "" for nothing.
std::string wrong_origin(const std::string& origin);

}  // namespace sheer::http
