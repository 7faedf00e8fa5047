#pragma once
#include "server/http/guard.h"
#include "server/http/message.h"
#include "server/http/router.h"

namespace sheer::http {

/// From a request to its answer: guard, route, query, handler, headers. Knows no sockets. Safe to call from any thread.
class Application {
  public:
    Application(Guard guard, Router router) : m_guard(std::move(guard)), m_router(std::move(router)) {}
    /// Never throws: what goes wrong is a problem. HEAD is answered like GET; the sender leaves out the body.
    Answer answer(Request request) const;
    /// How a request of this method and target is to be treated before its body is there.
    Handling handling(std::string_view method, std::string_view target) const;

  private:
    Answer handle(Request& request) const;

    Guard m_guard;
    Router m_router;
};

/// What every response gets: headers against misuse by other sites.
Response finished(Response response);
/// To a request that changes nothing, the same; 304 where its sender has it already, 412 where it wants another one.
Response unless_known(Response response, const Request& request);

/// The body of a request as JSON. Throws Problem: 400 if it is none, or nested so deep that it can only be meant badly.
nlohmann::json json_body(const Request& request);

}  // namespace sheer::http
