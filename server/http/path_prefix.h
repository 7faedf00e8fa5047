#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace sheer::http {

/// The path under which a proxy offers the service, such as "/sheer"; "" for none. The handlers know nothing of it:
/// it is taken from the targets of requests and put before the paths in answers. A proxy may also take it away itself.
class PathPrefix {
  public:
    explicit PathPrefix(std::string prefix = "") : m_prefix(std::move(prefix)) {}

    std::string_view stripped(std::string_view target) const;
    /// The answer to a request for the prefix itself, whose links would be wrong without a slash at its end.
    std::optional<Response> redirection(std::string_view target) const;
    /// With the prefix before the paths in Location and in the members `url` and `picture` of JSON.
    Response put_before(Response response) const;

  private:
    std::string m_prefix;
};

/// What is wrong with a prefix, to be read after its name; "" for nothing.
std::string wrong_path_prefix(std::string_view prefix);

/// A JSON text with `prefix` before the value of each member `url` and `picture` that is a path of the service.
/// Members of `tags` are the user's own, and stay.
std::string json_with_prefix(std::string_view text, std::string_view prefix);

}  // namespace sheer::http
