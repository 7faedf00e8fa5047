#include "server/http/changes.h"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace sheer::http {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

// Interval of checking whether anybody still waits, and delay after a failure.
constexpr std::chrono::milliseconds watch_limit = 200ms, pause_after_error = 1s;
constexpr auto token = asio::as_tuple(asio::use_awaitable);

}  // namespace

/// Registers a timer among those that wait, even if the wait is cut short.
class Changes::Entry {
  public:
    Entry(Changes& changes, asio::steady_timer& timer) : m_changes(changes), m_timer(timer) {
        m_changes.m_waiting.insert(&m_timer);
        m_changes.count_waiting(1);
    }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;
    ~Entry() {
        m_changes.m_waiting.erase(&m_timer);
        m_changes.count_waiting(-1);
    }

  private:
    Changes& m_changes;
    asio::steady_timer& m_timer;
};

Changes::Changes(asio::io_context& io, std::unique_ptr<ChangeWatch> store_watch)
    : m_io(io), m_watch(std::move(store_watch)), m_thread([this](const std::stop_token& stop) { watch(stop); }) {}

asio::awaitable<void> Changes::wait(std::uint64_t seen, std::chrono::milliseconds limit) {
    if (m_stopped || m_generation != seen) co_return;
    asio::steady_timer timer(m_io, limit);
    const Entry entry(*this, timer);
    co_await timer.async_wait(token);
}

void Changes::count_waiting(int more) {
    {
        const std::lock_guard lock(m_mutex);
        m_waiting_count += more;
    }
    m_wanted.notify_one();
}

void Changes::watch(const std::stop_token& stop) {
    std::unique_lock lock(m_mutex);
    while (m_wanted.wait(lock, stop, [this] { return m_waiting_count > 0; })) {
        lock.unlock();
        const bool looked = look();
        lock.lock();
        if (!looked) m_wanted.wait_for(lock, stop, pause_after_error, [] { return false; });
    }
}

/// Returns false if the store cannot be watched at the moment. Waiting requests then see the error when they read from
/// it.
bool Changes::look() {
    bool looked = true, changed = true;
    try {
        changed = m_watch->wait(watch_limit);
    } catch (const std::exception& error) {
        spdlog::error("waiting for changes: {}", error.what());
        looked = false;
    }
    if (changed) asio::post(m_io, [this] { wake(); });
    return looked;
}

void Changes::wake() {
    ++m_generation;
    for (asio::steady_timer* timer : m_waiting) timer->cancel();
}

void Changes::stop() {
    m_stopped = true;
    wake();
}

void Changes::join() {
    m_thread.request_stop();
    if (m_thread.joinable()) m_thread.join();
}

}  // namespace sheer::http
