#pragma once
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <type_traits>

namespace sheer::http {

/// Runs `work` on the pool and returns to the connection's thread with its result.
template <typename Work>
boost::asio::awaitable<std::invoke_result_t<Work&>> on_pool(boost::asio::thread_pool& pool, Work work) {
    auto run = [](Work inner) -> boost::asio::awaitable<std::invoke_result_t<Work&>> { co_return inner(); };
    co_return co_await boost::asio::co_spawn(pool, run(std::move(work)), boost::asio::use_awaitable);
}

/// Work on the pool for which a connection waits in steps, so that it can do something in between, or end: then the
/// work continues and its result is ignored. Used on the connection's thread.
template <typename Result>
class PoolWork {
  public:
    /// `work` returns a Result and owns what it needs. `connection` is the executor on which this object is used.
    template <typename Work>
    PoolWork(boost::asio::thread_pool& pool, const boost::asio::any_io_executor& connection, Work work)
        : m_shared(std::make_shared<Shared>(connection)) {
        boost::asio::post(pool, [shared = m_shared, work = std::move(work)]() mutable {
            std::optional<Result> result;
            std::exception_ptr error;
            try {
                result = work();
            } catch (const std::exception&) {
                error = std::current_exception();
            }
            boost::asio::post(shared->over.get_executor(), [shared, result = std::move(result), error]() mutable {
                shared->result = std::move(result);
                shared->error = error;
                shared->over.cancel();
            });
        });
    }

    /// Waits until the work has ended, or until `limit`; returns whether it has ended.
    boost::asio::awaitable<bool> wait(std::chrono::steady_clock::time_point limit) {
        while (!is_over() && std::chrono::steady_clock::now() < limit) {
            m_shared->over.expires_at(limit);
            co_await m_shared->over.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
        }
        co_return is_over();
    }

    /// The result of the work, once it has ended; throws what it threw.
    Result take() {
        if (m_shared->error) std::rethrow_exception(m_shared->error);
        return std::move(*m_shared->result);
    }

  private:
    struct Shared {
        explicit Shared(const boost::asio::any_io_executor& connection) : over(connection) {}
        boost::asio::steady_timer over;
        std::optional<Result> result;
        std::exception_ptr error;
    };

    bool is_over() const { return m_shared->result || m_shared->error; }

    std::shared_ptr<Shared> m_shared;
};

}  // namespace sheer::http
