#pragma once
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <set>

namespace sheer::http {

/// Tells all who wait that something in the store changed, by asking it once for all of them. Used on the thread of the
/// io_context only. The question (SQLite's data_version) reads shared memory and takes microseconds, so it is asked on
/// that thread.
class Changes {
  public:
    Changes(boost::asio::io_context& io, std::function<std::int64_t()> counter);

    /// Grows with each change. Take it before looking at the store, and give it to `wait`: no change is missed.
    std::uint64_t generation() const { return m_generation; }
    /// Returns when the generation is no longer `seen`, or after `limit`.
    boost::asio::awaitable<void> wait(std::uint64_t seen, std::chrono::milliseconds limit);
    /// Wakes all, now and for good.
    void stop();

  private:
    boost::asio::awaitable<void> watch();
    void look();
    void wake();

    boost::asio::io_context& m_io;
    std::function<std::int64_t()> m_counter;
    std::int64_t m_last = -1;
    std::uint64_t m_generation = 0;
    bool m_watching = false;
    bool m_stopped = false;
    std::set<boost::asio::steady_timer*> m_waiting;
};

}  // namespace sheer::http
