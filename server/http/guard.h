#pragma once
#include <optional>
#include <set>
#include <string>

#include "server/http/message.h"

namespace sheer::http {

/// Keeps web pages of other sites from using a service that trusts whoever can reach its port.
struct Guard {
    /// Names that a request may ask for in Host; empty allows any. A page whose name was pointed at this machine (DNS
    /// rebinding) sends its own name.
    std::set<std::string> hosts;
    /// The problem, or nothing if the request may go on.
    std::optional<Response> refusal(const Request& request) const;
};

/// On loopback only the names of loopback and those in `allowed`; elsewhere those in `allowed` and loopback, or any if
/// `allowed` is empty.
Guard make_guard(bool on_loopback, std::set<std::string> allowed);

}  // namespace sheer::http
