#include "server/http/response_writer.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <ctime>
#include <iterator>

#include "server/http/pool_work.h"
#include "server/http/problem.h"

namespace sheer::http {

namespace asio = boost::asio;

namespace {

constexpr auto token = asio::as_tuple(asio::use_awaitable);
// The part of a body that is sent at a time.
constexpr std::uint64_t piece_bytes = 64 << 10;

/// RFC 9110, 5.6.7.
std::string http_date() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 40> text;
    return {text.data(), std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc)};
}

/// RFC 9112, 4 and 5; `length` is that of the body, nothing if there is none or it ends with the connection.
std::string head_text(const Response& response, std::optional<std::uint64_t> length, bool keep_alive) {
    std::string text;
    text.reserve(512);
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "HTTP/1.1 {} {}\r\n", response.status, status_phrase(response.status));
    for (const auto& [name, value] : response.headers.fields()) fmt::format_to(out, "{}: {}\r\n", name, value);
    fmt::format_to(out, "Date: {}\r\n", http_date());
    if (length) fmt::format_to(out, "Content-Length: {}\r\n", *length);
    text += keep_alive ? "\r\n" : "Connection: close\r\n\r\n";
    return text;
}

}  // namespace

asio::awaitable<bool> ResponseWriter::write(Response response, bool head_only, bool keep_alive) {
    const auto* content = std::get_if<ContentPtr>(&response.body);
    const auto* text = std::get_if<std::string>(&response.body);
    const bool has_body = response.status != 204 && response.status != 304;
    std::optional<std::uint64_t> length;
    if (has_body) length = content ? (*content)->size_bytes() : text->size();
    const std::string head = head_text(response, length, keep_alive);
    if (head_only || !has_body) co_return co_await send(head, "");
    if (content) co_return co_await write_content(head, **content);
    co_return co_await send(head, *text);
}

asio::awaitable<bool> ResponseWriter::write_endless(const Response& response) {
    const std::string head = head_text(response, std::nullopt, false);
    co_return co_await send(head, "");
}

asio::awaitable<bool> ResponseWriter::write_text(std::string_view text) {
    co_return co_await send("", text);
}

/// Reading from a store may take a long time, so the pool reads one piece at a time.
asio::awaitable<bool> ResponseWriter::write_content(std::string_view head, const Content& content) {
    const bool begun = co_await send(head, "");
    if (!begun) co_return false;
    const std::uint64_t size = content.size_bytes();
    std::string piece;
    for (std::uint64_t done = 0; done < size; done += piece.size()) {
        piece.resize(std::min<std::uint64_t>(size - done, piece_bytes));
        co_await on_pool(m_pool, [&] { content.read(done, piece); });
        const bool sent = co_await send("", piece);
        if (!sent) co_return false;
    }
    co_return true;
}

asio::awaitable<bool> ResponseWriter::send(std::string_view head, std::string_view body) {
    while (!head.empty() || !body.empty()) {
        m_stream.expires_after(m_timeout);
        const std::array<asio::const_buffer, 2> next = {asio::buffer(head), asio::buffer(body, piece_bytes)};
        auto [error, count] = co_await m_stream.async_write_some(next, token);
        if (error) co_return false;
        const std::size_t of_head = std::min(count, head.size());
        head.remove_prefix(of_head);
        body.remove_prefix(count - of_head);
    }
    m_stream.expires_never();
    co_return true;
}

}  // namespace sheer::http
