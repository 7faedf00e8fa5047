#include "server/http/server.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <charconv>
#include <csignal>

#include "server/http/session.h"

namespace sheer::http {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

constexpr auto token = asio::as_tuple(asio::use_awaitable);
// Connections beyond the limit. They are for probes, which ask one question and end.
constexpr std::ptrdiff_t spare_seats = 8;

tcp::endpoint tcp_endpoint(const Endpoint& endpoint) {
    return {asio::ip::make_address(endpoint.address), endpoint.port};
}

asio::awaitable<void> serve(std::shared_ptr<Session> session) {
    co_await session->run();
}

}  // namespace

Endpoint parse_endpoint(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) throw std::invalid_argument("'" + text + "' is not ADDRESS:PORT");
    std::string address = text.substr(0, colon);
    if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
    if (address == "localhost") address = "127.0.0.1";
    boost::system::error_code bad_address;
    asio::ip::make_address(address, bad_address);
    if (bad_address) throw std::invalid_argument("'" + address + "' is not a numeric address");
    Endpoint endpoint{.address = address};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, endpoint.port);
    if (error != std::errc() || stop != end) throw std::invalid_argument("'" + text + "' has no port from 0 to 65535");
    return endpoint;
}

bool is_loopback(const Endpoint& endpoint) {
    return asio::ip::make_address(endpoint.address).is_loopback();
}

std::string url_of(const Endpoint& endpoint) {
    const bool v6 = asio::ip::make_address(endpoint.address).is_v6();
    return v6 ? fmt::format("http://[{}]:{}", endpoint.address, endpoint.port)
              : fmt::format("http://{}:{}", endpoint.address, endpoint.port);
}

class Server::Impl {
  public:
    Impl(const Endpoint& endpoint, const Limits& limits, Hooks hooks)
        : m_limits(limits),
          m_reload(std::move(hooks.reload)),
          m_alive(std::move(hooks.alive)),
          m_alive_interval(hooks.alive_interval),
          m_changes(m_io, std::move(hooks.changes)),
          m_context{.limits = m_limits,
                    .answer = std::move(hooks.answer),
                    .known = std::move(hooks.known),
                    .handling = std::move(hooks.handling),
                    .pool = m_pool,
                    .spec_pool = m_spec_pool,
                    .changes = m_changes,
                    .lasting = LastingAnswers(m_limits),
                    .spool = std::move(hooks.spool),
                    .sessions = {},
                    .stopping = false,
                    .on_end = [this] { session_ended(); }},
          m_io(1),
          m_pool(static_cast<std::size_t>(limits.threads)),
          m_spec_pool(static_cast<std::size_t>(std::max(1, limits.threads / 2))),
          m_acceptor(m_io, tcp_endpoint(endpoint)),
          m_signals(m_io, SIGINT, SIGTERM),
          m_hangup(m_io, SIGHUP),
          m_stop_timer(m_io),
          m_alive_timer(m_io) {}

    ~Impl() {
        m_changes.join();
        // Interrupted connections end with m_io, after the timer and the signals.
        m_context.on_end = [] {};
    }

    Endpoint endpoint() const {
        const tcp::endpoint local = m_acceptor.local_endpoint();
        return {local.address().to_string(), local.port()};
    }

    void run() {
        asio::co_spawn(m_io, accept(), asio::detached);
        await_hangup();
        await_alive();
        m_signals.async_wait([this](boost::system::error_code error, int) {
            if (!error) stop();
        });
        m_io.run();
        m_changes.join();
        m_pool.join();
        // Nobody waits any longer for the specs that no thread has started to check.
        m_spec_pool.stop();
        m_spec_pool.join();
    }

  private:
    void await_hangup() {
        m_hangup.async_wait([this](boost::system::error_code error, int) {
            if (error) return;
            m_reload();
            await_hangup();
        });
    }

    void await_alive() {
        if (m_alive_interval.count() == 0) return;
        m_alive();
        m_alive_timer.expires_after(m_alive_interval);
        m_alive_timer.async_wait([this](boost::system::error_code error) {
            if (!error) await_alive();
        });
    }

    asio::awaitable<void> accept() {
        while (!m_context.stopping) {
            auto [error, socket] = co_await m_acceptor.async_accept(token);
            if (error == asio::error::operation_aborted || m_context.stopping) co_return;
            if (error) {
                spdlog::warn("a connection cannot be accepted: {}", error.message());
                // Most likely there are no free descriptors: retrying at once would not help.
                asio::steady_timer pause(m_io, 100ms);
                co_await pause.async_wait(token);
                continue;
            }
            auto session = make_session(std::move(socket), free_seat(), m_context);
            asio::co_spawn(m_io, serve(session), asio::detached);
        }
    }

    /// If all connections are in use, one that waits for a request is closed to make room.
    Seat free_seat() {
        const auto taken = [this](Seat seat) {
            return std::ranges::count_if(m_context.sessions, [&](const Session* session) {
                return !session->is_over() && session->seat() == seat;
            });
        };
        if (taken(Seat::ordinary) < m_limits.max_connections || drop_idle(m_context.sessions)) return Seat::ordinary;
        if (taken(Seat::spare) >= spare_seats) drop_oldest_spare();
        return Seat::spare;
    }

    void drop_oldest_spare() {
        Session* oldest = nullptr;
        for (Session* session : m_context.sessions)
            if (!session->is_over() && session->seat() == Seat::spare &&
                (oldest == nullptr || session->begun() < oldest->begun()))
                oldest = session;
        if (oldest != nullptr) oldest->drop();
    }

    void stop() {
        m_context.stopping = true;
        m_acceptor.close();
        m_changes.stop();
        const std::set<Session*> sessions = m_context.sessions;
        for (Session* session : sessions) session->stop();
        m_stop_timer.expires_after(m_limits.stop_timeout);
        m_stop_timer.async_wait([this](boost::system::error_code error) {
            if (!error) m_io.stop();
        });
        m_signals.async_wait([this](boost::system::error_code error, int) {
            if (!error) m_io.stop();
        });
        session_ended();
    }

    void session_ended() {
        if (!m_context.stopping || !m_context.sessions.empty()) return;
        m_stop_timer.cancel();
        m_signals.cancel();
        m_hangup.cancel();
        m_alive_timer.cancel();
    }

    const Limits m_limits;
    const std::function<void()> m_reload, m_alive;
    const std::chrono::milliseconds m_alive_interval;
    // Interrupted connections end with m_io and still use these.
    Changes m_changes;
    SessionContext m_context;
    asio::io_context m_io;
    asio::thread_pool m_pool;
    asio::thread_pool m_spec_pool;
    tcp::acceptor m_acceptor;
    asio::signal_set m_signals, m_hangup;
    asio::steady_timer m_stop_timer, m_alive_timer;
};

Server::Server(const Endpoint& endpoint, const Limits& limits, Hooks hooks) try
    : m_impl(std::make_unique<Impl>(endpoint, limits, std::move(hooks))) {
} catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen on {}:{}: {}", endpoint.address, endpoint.port, error.code().message()));
}

Server::~Server() = default;
Endpoint Server::endpoint() const {
    return m_impl->endpoint();
}
void Server::run() {
    m_impl->run();
}

}  // namespace sheer::http
