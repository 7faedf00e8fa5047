#include "server/cli/http_client.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/url/parse.hpp>

#include "renderer/command/command.h"

namespace sheer::cli {

namespace beast = boost::beast;
namespace net = boost::asio;

namespace {

constexpr std::uint64_t max_answer_bytes = std::uint64_t{1} << 30;

std::string header_name(std::string_view text) {
    std::string all(text);
    std::ranges::transform(all, all.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return all;
}

/// Runs one asynchronous operation to its end: only those respect the time limit of a stream.
template <typename Start>
void run_operation(net::io_context& context, const std::string& doing, const Start& start) {
    beast::error_code error;
    start([&error](const beast::error_code& result, auto&&...) { error = result; });
    context.restart();
    context.run();
    if (error) throw Unreachable(fmt::format("{}: {}", doing, error.message()));
}

}  // namespace

std::string HttpAnswer::header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
}

HttpClient::HttpClient(std::string_view url, std::string token) : m_url(url), m_token(std::move(token)) {
    const auto parsed = boost::urls::parse_uri(url);
    if (!parsed || parsed->scheme() != "http" || parsed->encoded_host().empty() || parsed->has_query())
        throw UsageError(fmt::format("the server must be http://HOST:PORT, not \"{}\"", url));
    m_host = parsed->host_address();
    m_port = parsed->has_port() ? std::string(parsed->port()) : "80";
    m_path = parsed->path();
    while (m_path.ends_with('/')) m_path.pop_back();
}

HttpAnswer HttpClient::request(const std::string& method, const std::string& target, const std::string& body,
                               const HttpFields& fields, std::chrono::seconds limit) const {
    net::io_context context;
    net::ip::tcp::resolver resolver(context);
    beast::error_code unresolved;
    const auto endpoints = resolver.resolve(m_host, m_port, unresolved);
    if (unresolved) throw Unreachable(fmt::format("{}: {}", m_url, unresolved.message()));
    beast::tcp_stream stream(context);
    stream.expires_after(limit);
    run_operation(context, m_url, [&](auto done) { stream.async_connect(endpoints, done); });

    beast::http::request<beast::http::string_body> request;
    request.method_string(method);
    request.target(m_path + target);
    request.set(beast::http::field::host, m_port == "80" ? m_host : fmt::format("{}:{}", m_host, m_port));
    request.set(beast::http::field::user_agent, "sheer");
    request.set(beast::http::field::connection, "close");
    if (!m_token.empty()) request.set(beast::http::field::authorization, "Bearer " + m_token);
    for (const auto& [name, value] : fields) request.set(name, value);
    request.body() = body;
    if (!body.empty() || method == "POST" || method == "PUT") request.prepare_payload();
    run_operation(context, m_url, [&](auto done) { beast::http::async_write(stream, request, done); });

    beast::flat_buffer buffer;
    beast::http::response_parser<beast::http::string_body> parser;
    parser.body_limit(max_answer_bytes);
    stream.expires_after(limit);
    run_operation(context, m_url, [&](auto done) { beast::http::async_read(stream, buffer, parser, done); });
    HttpAnswer answer{.status = static_cast<int>(parser.get().result_int()), .headers = {}, .body = {}};
    for (const auto& field : parser.get())
        answer.headers[header_name(field.name_string())] = std::string(field.value());
    answer.body = std::move(parser.get().body());
    return answer;
}

}  // namespace sheer::cli
