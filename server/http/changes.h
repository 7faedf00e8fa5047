#pragma once
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "server/jobs/change_watch.h"

namespace sheer::http {

/// Tells all waiting requests that something in the store changed. A separate thread watches the store for all of them,
/// only while there are any. Everything else is used only on the thread of the io_context.
class Changes {
  public:
    Changes(boost::asio::io_context& io, std::unique_ptr<ChangeWatch> watch);
    Changes(const Changes&) = delete;
    Changes& operator=(const Changes&) = delete;
    ~Changes() { join(); }

    /// Grows with each change. Read it before reading the store, and pass it to `wait`, so that no change is missed.
    std::uint64_t generation() const { return m_generation; }
    /// Returns when the generation is no longer `seen`, or after `limit`.
    boost::asio::awaitable<void> wait(std::uint64_t seen, std::chrono::milliseconds limit);
    /// Wakes all waiting requests, now and for good.
    void stop();
    /// Ends the thread, which may be waiting for the store, so it must not be called on the thread of the connections.
    /// Must be called before the io_context is destroyed.
    void join();

  private:
    class Entry;

    void watch(const std::stop_token& stop);
    bool look();
    void count_waiting(int more);
    void wake();

    boost::asio::io_context& m_io;
    std::unique_ptr<ChangeWatch> m_watch;
    std::uint64_t m_generation = 0;
    bool m_stopped = false;
    std::set<boost::asio::steady_timer*> m_waiting;
    std::mutex m_mutex;
    std::condition_variable_any m_wanted;
    int m_waiting_count = 0;  ///< guarded by m_mutex
    std::jthread m_thread;
};

}  // namespace sheer::http
