#pragma once
#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "server/http/message.h"
#include "server/http/spooled_body.h"

namespace sheer::http {

/// A parser that has read the header of a request.
using HeadParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

/// From where a body comes, and to where a long one goes.
struct BodyRoute {
    boost::beast::tcp_stream& stream;
    boost::beast::flat_buffer& buffer;   ///< what has been read of the stream
    const std::filesystem::path& spool;  ///< folder for long bodies on their way
    std::uint64_t& spooled_bytes;        ///< of all that are on their way
    std::uint64_t most_spooled_bytes;
};

/// The body of a request: in memory, or in a file if it is long.
struct ReceivedBody {
    std::string text;
    std::optional<SpooledBody> spooled;
};

/// Reads the body of the request whose header `parser` has read, at most `limit` bytes of it. The stream's timeout is
/// the caller's. Ends early, without an error, if all long bodies together become too many. Throws std::system_error if
/// there is no room for a long one.
boost::asio::awaitable<boost::beast::error_code> receive_body(BodyRoute route, HeadParser& parser, std::uint64_t limit,
                                                              ReceivedBody& body);

/// The answer to a request whose body found no room, which the log explains.
Response no_room_for_body(const Request& request, const std::system_error& error);
/// The answer while too many long bodies are on their way.
Response too_many_bodies();

}  // namespace sheer::http
