#pragma once
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <string_view>

#include "server/http/message.h"

namespace sheer::http {

/// Sends responses on a connection, and lets the other connections have their turn within a long one.
class ResponseWriter {
  public:
    /// `pool` reads what is sent from a store. The other side has `timeout` to accept each piece.
    ResponseWriter(boost::beast::tcp_stream& stream, boost::asio::thread_pool& pool, std::chrono::milliseconds timeout)
        : m_stream(stream), m_pool(pool), m_timeout(timeout) {}

    /// The answer to a request whose method is HEAD if `head_only`. Returns whether all of it was sent.
    boost::asio::awaitable<bool> write(Response response, bool head_only, bool keep_alive);
    /// The head of an answer whose end is that of the connection.
    boost::asio::awaitable<bool> write_endless(const Response& head);
    boost::asio::awaitable<bool> write_text(std::string_view text);

  private:
    boost::asio::awaitable<bool> write_content(std::string_view head, const Content& content);
    boost::asio::awaitable<bool> send(std::string_view head, std::string_view body);

    boost::beast::tcp_stream& m_stream;
    boost::asio::thread_pool& m_pool;
    const std::chrono::milliseconds m_timeout;
};

}  // namespace sheer::http
