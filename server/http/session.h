#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "server/http/changes.h"
#include "server/http/lasting.h"
#include "server/http/limits.h"
#include "server/http/message.h"
#include "server/http/server.h"

namespace sheer::http {

class Session;

/// Shared by the connections of a server. Used only on the io_context's thread.
struct SessionContext {
    const Limits& limits;
    std::function<Answer(Request)> answer;  ///< called on the pool
    std::function<std::optional<Response>(const Request&)> known;
    HandlingOf handling;
    boost::asio::thread_pool& pool;
    boost::asio::thread_pool& spec_pool;
    Changes& changes;
    LastingAnswers lasting;
    std::filesystem::path spool;      ///< folder for long bodies on their way
    std::uint64_t spooled_bytes = 0;  ///< of all that are on their way
    std::set<Session*> sessions;
    bool stopping = false;
    std::function<void()> on_end;  ///< called when a session has ended
};

/// A spare seat is a connection beyond the limit: one probe is answered on it, anything else gets 503.
enum class Seat { ordinary, spare };

/// One connection.
class Session {
  public:
    using SteadyTime = std::chrono::steady_clock::time_point;

    virtual ~Session() = default;
    /// Serves requests until either side ends the connection.
    virtual boost::asio::awaitable<void> run() = 0;
    /// Ends it at once if it waits for a request, otherwise after the pending answer.
    virtual void stop() = 0;
    /// Ends it at once.
    virtual void drop() = 0;
    virtual Seat seat() const = 0;
    virtual SteadyTime begun() const = 0;
    /// The time from which it may be ended in favor of another one: it waits for a request that does not come, or comes
    /// slowly. Nothing while an answer is made or sent.
    virtual std::optional<SteadyTime> dispensable_from() const = 0;
    /// Whether it was ended, and only its destructor has not run yet.
    virtual bool is_over() const = 0;
};

std::shared_ptr<Session> make_session(boost::asio::ip::tcp::socket socket, Seat seat, SessionContext& context);

/// Ends the ordinary connection that has waited longest for a request, if there is one. Returns whether it did.
bool drop_idle(const std::set<Session*>& sessions);

}  // namespace sheer::http
