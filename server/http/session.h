#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <set>

#include "server/http/changes.h"
#include "server/http/limits.h"
#include "server/http/message.h"
#include "server/http/server.h"

namespace sheer::http {

class Session;

/// What the connections of a server share. Used on the io_context's thread only.
struct SessionContext {
    const Limits& limits;
    std::function<Answer(Request)> answer;  ///< called on the pool
    BodyLimit body_limit;
    boost::asio::thread_pool& pool;
    Changes& changes;
    std::set<Session*> sessions;
    bool stopping = false;
    std::function<void()> on_end;  ///< called when a session ended
};

/// One connection.
class Session {
  public:
    virtual ~Session() = default;
    /// Serves requests until either side ends the connection.
    virtual boost::asio::awaitable<void> run() = 0;
    /// Answers 503 without reading, for one connection too many.
    virtual boost::asio::awaitable<void> refuse() = 0;
    /// Ends it at once if it waits for a request, else after the answer that is on its way.
    virtual void stop() = 0;
};

std::shared_ptr<Session> make_session(boost::asio::ip::tcp::socket socket, SessionContext& context);

}  // namespace sheer::http
