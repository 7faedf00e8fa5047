#include "server/http/changes.h"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace sheer::http {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

constexpr auto look_interval = 50ms;
constexpr auto token = asio::as_tuple(asio::use_awaitable);

/// A timer's place among those that wait, also when the wait is cut short.
class Entry {
  public:
    Entry(std::set<asio::steady_timer*>& waiting, asio::steady_timer& timer) : m_waiting(waiting), m_timer(timer) {
        m_waiting.insert(&m_timer);
    }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;
    ~Entry() { m_waiting.erase(&m_timer); }

  private:
    std::set<asio::steady_timer*>& m_waiting;
    asio::steady_timer& m_timer;
};

}  // namespace

Changes::Changes(asio::io_context& io, std::function<std::int64_t()> counter)
    : m_io(io), m_counter(std::move(counter)) {}

asio::awaitable<void> Changes::wait(std::uint64_t seen, std::chrono::milliseconds limit) {
    if (m_stopped || m_generation != seen) co_return;
    asio::steady_timer timer(m_io, limit);
    const Entry entry(m_waiting, timer);
    if (!m_watching) {
        m_watching = true;
        asio::co_spawn(m_io, watch(), asio::detached);
    }
    co_await timer.async_wait(token);
}

asio::awaitable<void> Changes::watch() {
    asio::steady_timer timer(m_io);
    while (!m_waiting.empty()) {
        look();
        timer.expires_after(look_interval);
        co_await timer.async_wait(token);
    }
    m_watching = false;
}

void Changes::look() {
    try {
        const std::int64_t now = m_counter();
        if (now == m_last) return;
        m_last = now;
    } catch (const std::exception& error) {
        spdlog::error("waiting for changes: {}", error.what());
    }
    wake();
}

void Changes::wake() {
    ++m_generation;
    for (asio::steady_timer* timer : m_waiting) timer->cancel();
}

void Changes::stop() {
    m_stopped = true;
    wake();
}

}  // namespace sheer::http
