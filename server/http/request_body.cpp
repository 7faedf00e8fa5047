#include "server/http/request_body.h"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "server/http/problem.h"

namespace sheer::http {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace bhttp = boost::beast::http;

namespace {

constexpr auto token = asio::as_tuple(asio::use_awaitable);
// The part of a body that is read at a time.
constexpr std::uint64_t piece_bytes = 64 << 10;
// A longer body goes to a file until it is complete.
constexpr std::uint64_t longest_body_in_memory = 1 << 20;

asio::awaitable<beast::error_code> receive_long_body(BodyRoute route, HeadParser& parser, SpooledBody& spooled) {
    bhttp::request_parser<bhttp::buffer_body> pieces(std::move(parser));
    std::string piece(piece_bytes, '\0');
    while (!pieces.is_done() && route.spooled_bytes <= route.most_spooled_bytes) {
        pieces.get().body().data = piece.data();
        pieces.get().body().size = piece.size();
        auto [error, count] = co_await bhttp::async_read(route.stream, route.buffer, pieces, token);
        if (error && error != bhttp::error::need_buffer) co_return error;
        spooled.append(std::string_view(piece).substr(0, piece.size() - pieces.get().body().size));
    }
    co_return beast::error_code();
}

}  // namespace

asio::awaitable<beast::error_code> receive_body(BodyRoute route, HeadParser& parser, std::uint64_t limit,
                                                ReceivedBody& body) {
    if (parser.content_length().value_or(parser.chunked() ? limit : 0) > longest_body_in_memory) {
        body.spooled.emplace(route.spool, route.spooled_bytes);
        co_return co_await receive_long_body(route, parser, *body.spooled);
    }
    bhttp::request_parser<bhttp::string_body> whole(std::move(parser));
    auto [error, count] = co_await bhttp::async_read(route.stream, route.buffer, whole, token);
    body.text = std::move(whole.get().body());
    co_return error;
}

Response no_room_for_body(const Request& request, const std::system_error& error) {
    spdlog::error("{} {}: {}", request.method, request.target, error.what());
    return problem(507, "There is no room for the body.");
}

Response too_many_bodies() {
    Response response = problem(503, "Too many long bodies are on their way; try again later.");
    response.headers.add("Retry-After", "10");
    return response;
}

}  // namespace sheer::http
