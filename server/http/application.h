#pragma once
#include <memory>

#include "server/http/access.h"
#include "server/http/body_cache.h"
#include "server/http/guard.h"
#include "server/http/message.h"
#include "server/http/path_prefix.h"
#include "server/http/router.h"

namespace sheer::http {

/// From a request to its answer: guard, route, token, query, handler, headers. Independent of sockets. Safe to call
/// from any thread.
class Application {
  public:
    Application(Guard guard, Router router, PathPrefix prefix = PathPrefix(), Access access = {})
        : m_guard(std::move(guard)), m_router(std::move(router)), m_prefix(std::move(prefix)), m_access(access) {}
    /// Never throws: errors become problems. HEAD is answered like GET; the sender leaves out the body.
    Answer answer(Request request) const;
    /// The same answer if it is in memory, and nothing otherwise. Does not wait.
    std::optional<Response> known(Request request) const;
    /// The pattern of the route of such a request; "" for none.
    std::string pattern_of(std::string_view method, std::string_view target) const;
    /// How to treat a request with this method and target before its body has arrived.
    Handling handling(std::string_view method, std::string_view target) const;

  private:
    /// The route of the request, which then has its values and its query; or the response instead. Throws Problem.
    std::variant<const Route*, Response> admitted(Request& request) const;
    Answer handle(Request& request) const;
    /// With the headers for this request, and without its body if the sender has that.
    Response prepared(Response response, const Request& request) const;
    /// In the form in which its sender wants it.
    Response sent(Response response, const Request& request) const;

    Guard m_guard;
    Router m_router;
    PathPrefix m_prefix;
    Access m_access;
    std::shared_ptr<BodyCache> m_packed = std::make_shared<BodyCache>(std::size_t{32} << 20);
};

/// Added to every response: headers that protect against misuse by other sites.
Response finished(Response response);

/// The body of a request as JSON. Throws Problem: 400 if it is not JSON, or is nested so deeply that it must be
/// malicious.
nlohmann::json json_body(const Request& request);

}  // namespace sheer::http
