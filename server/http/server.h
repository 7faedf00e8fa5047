#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/limits.h"
#include "server/http/message.h"
#include "server/jobs/change_watch.h"

namespace sheer::http {

/// Where to listen: a numeric address and a port, 0 for any free port.
struct Endpoint {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;
};

/// Reads "ADDR:PORT", also "[::1]:PORT" and "localhost:PORT". Throws std::invalid_argument.
Endpoint parse_endpoint(const std::string& text);
bool is_loopback(const Endpoint& endpoint);
/// "http://127.0.0.1:8080"
std::string url_of(const Endpoint& endpoint);

/// How to treat requests with this method and target. Called on the thread of the connections.
using HandlingOf = std::function<Handling(std::string_view method, std::string_view target)>;

/// An HTTP/1.1 server. The thread in `run` serves the connections, a pool makes the answers.
class Server {
  public:
    using Answerer = std::function<Answer(Request)>;

    /// What the server needs from the rest of the program.
    struct Hooks {
        Answerer answer;
        HandlingOf handling;
        /// The answer to a request that may be known, if it is; on the thread of the connections.
        std::function<std::optional<Response>(const Request&)> known = [](const Request&) { return std::nullopt; };
        std::unique_ptr<ChangeWatch> changes;        ///< the store's
        std::function<void()> reload;                ///< on SIGHUP; on the thread of the connections
        std::function<void()> alive = {};            ///< every `alive_interval`, on the same thread
        std::chrono::milliseconds alive_interval{};  ///< 0: never
        /// Folder for long bodies on their way; files there have no names.
        std::filesystem::path spool = std::filesystem::temp_directory_path();
    };

    /// Listens at once; connections wait until `run`. Throws std::runtime_error.
    Server(const Endpoint& endpoint, const Limits& limits, Hooks hooks);
    ~Server();

    /// Where it listens, with the actual port.
    Endpoint endpoint() const;
    /// Serves until SIGINT or SIGTERM, then finishes pending answers; a second signal ends those too.
    void run();

  private:
    class Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace sheer::http
