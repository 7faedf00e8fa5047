#include "server/http/session.h"

#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "server/http/application.h"
#include "server/http/pool_work.h"
#include "server/http/problem.h"
#include "server/http/request_body.h"
#include "server/http/request_head.h"
#include "server/http/response_writer.h"

namespace sheer::http {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace bhttp = boost::beast::http;
using asio::ip::tcp;
using asio::experimental::awaitable_operators::operator||;
using Milliseconds = std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr auto token = asio::as_tuple(asio::use_awaitable);
constexpr std::chrono::seconds linger_timeout{10};
// How long a request may take to arrive before it counts as slow, if another client needs its connection.
constexpr std::chrono::seconds slow_header{1}, slow_body{10};
// A new connection has not had time to send a request.
constexpr std::chrono::milliseconds newcomer_time{250};
constexpr std::string_view sign_of_life = ":\n\n";
// What the kernel holds of an answer beyond what is on its way. By default that grows to megabytes: a client that asks
// again and again without reading would have several long answers made and copied.
constexpr int most_unsent_bytes = 128 << 10;
using NotSent = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
// For a probe's request on a connection beyond the limit.
constexpr std::chrono::seconds spare_timeout{2};

Request request_without_body(const bhttp::request<bhttp::empty_body>& message) {
    Request request;
    request.method = std::string(message.method_string());
    request.target = std::string(message.target());
    for (const auto& field : message) request.headers.add(std::string(field.name_string()), std::string(field.value()));
    return request;
}

/// The problem for a request that cannot be read, or nothing if it could not be sent: the other side has closed the
/// connection, or it was too slow and the stream has closed itself.
std::optional<Response> problem_of(beast::error_code error) {
    if (error == bhttp::error::body_limit) return problem(413, "The body is too long.");
    if (error == bhttp::error::header_limit || error == bhttp::error::buffer_overflow)
        return problem(431, "The header is too long.");
    if (error == bhttp::error::end_of_stream || error == bhttp::error::partial_message) return std::nullopt;
    if (error.category() == make_error_code(bhttp::error::bad_method).category())
        return problem(400, "This is not HTTP/1.1: " + error.message() + ".");
    return std::nullopt;
}

class TcpSession : public Session {
  public:
    TcpSession(tcp::socket socket, Seat seat, SessionContext& context)
        : m_context(context), m_limits(context.limits), m_seat(seat), m_stream(std::move(socket)) {
        m_context.sessions.insert(this);
        beast::error_code ignored;
        const tcp::endpoint client = m_stream.socket().remote_endpoint(ignored);
        if (!ignored) m_client = client.address().to_string();
        m_stream.socket().set_option(tcp::no_delay(true), ignored);
        m_stream.socket().set_option(NotSent(most_unsent_bytes), ignored);
    }

    ~TcpSession() override {
        m_context.sessions.erase(this);
        m_context.on_end();
    }

    asio::awaitable<void> run() override {
        try {
            for (bool keep = true; keep && !m_context.stopping;) keep = co_await serve_one();
        } catch (const std::exception& error) {
            spdlog::error("connection: {}", error.what());
        }
        close();
    }

    void stop() override {
        if (m_idle) close();
    }

    void drop() override { close(); }
    Seat seat() const override { return m_seat; }
    SteadyTime begun() const override { return m_begun; }
    std::optional<SteadyTime> dispensable_from() const override { return m_dispensable_from; }
    bool is_over() const override { return m_over; }

  private:
    void close() {
        m_over = true;
        m_dispensable_from.reset();
        beast::error_code ignored;
        m_stream.socket().shutdown(tcp::socket::shutdown_both, ignored);
        m_stream.close();
    }

    /// Returns whether the connection can be used again.
    asio::awaitable<bool> serve_one() {
        m_head = m_close = false;
        m_version = 11;
        const bool something = co_await wait_for_request();
        if (!something) co_return false;
        HeadParser parser;
        const beast::error_code header_error = co_await read_header(parser);
        m_head = parser.get().method() == bhttp::verb::head;
        if (header_error) co_return co_await reject(problem_of(header_error));
        m_version = parser.get().version();
        m_close = !parser.keep_alive() || m_seat == Seat::spare;
        Request request = request_without_body(parser.get());
        if (auto wrong = check_head(request, m_version)) co_return co_await reject(std::move(wrong));
        const Handling handling = m_context.handling(request.method, request.target);
        if (m_seat == Seat::spare && !handling.is_probe) co_return co_await reject(too_many_connections());
        ReceivedBody body;
        std::optional<Response> wrong_body;
        try {
            const beast::error_code body_error =
                co_await read_body(parser, handling.body_bytes.value_or(m_limits.body_bytes), body);
            if (body_error) co_return co_await reject(problem_of(body_error));
        } catch (const std::system_error& error) {
            wrong_body = no_room_for_body(request, error);
        }
        if (!wrong_body && body.spooled && m_context.spooled_bytes > m_limits.spool_bytes)
            wrong_body = too_many_bodies();
        if (wrong_body) {
            body.spooled.reset();
            co_return co_await reject(std::move(wrong_body));
        }
        request.body = std::move(body.text);
        m_dispensable_from.reset();
        Answer answer = co_await make_answer(std::move(request), handling, body.spooled);
        body.spooled.reset();
        co_return co_await write_answer(std::move(answer));
    }

    asio::awaitable<Answer> make_answer(Request request, const Handling& handling,
                                        const std::optional<SpooledBody>& spooled) {
        if (handling.lane == Lane::at_once && !spooled) co_return m_context.answer(std::move(request));
        if (handling.may_be_known && !spooled)
            if (auto known = m_context.known(request)) co_return std::move(*known);
        asio::thread_pool& pool = handling.lane == Lane::specs ? m_context.spec_pool : m_context.pool;
        co_return co_await on_pool(pool, [&] {
            try {
                if (spooled) request.body = spooled->text();
            } catch (const std::system_error& error) {
                return Answer(no_room_for_body(request, error));
            }
            return m_context.answer(std::move(request));
        });
    }

    static Response too_many_connections() {
        Response response = problem(503, "There are too many connections.");
        response.headers.add("Retry-After", "1");
        return response;
    }

    Milliseconds at_most(Milliseconds limit) const {
        return m_seat == Seat::spare ? std::min<Milliseconds>(limit, spare_timeout) : limit;
    }

    asio::awaitable<bool> wait_for_request() {
        if (m_buffer.size() > 0) co_return true;
        m_idle = true;
        m_dispensable_from = SteadyClock::now() + (m_has_asked ? Milliseconds(0) : newcomer_time);
        m_stream.expires_after(at_most(m_limits.idle_timeout));
        auto [error, count] = co_await m_stream.async_read_some(m_buffer.prepare(m_limits.header_bytes), token);
        m_idle = false;
        m_has_asked = true;
        m_buffer.commit(count);
        co_return !error;
    }

    asio::awaitable<beast::error_code> read_header(HeadParser& parser) {
        parser.header_limit(m_limits.header_bytes);
        // The declared length is compared with the limit after the header is read, so that the answer can be a clean
        // 413.
        parser.body_limit(boost::none);
        m_dispensable_from = SteadyClock::now() + slow_header;
        m_stream.expires_after(at_most(m_limits.header_timeout));
        // Most headers are there as a whole, and reading none costs as much as reading one.
        beast::error_code error;
        m_buffer.consume(parser.put(m_buffer.data(), error));
        if (parser.is_header_done() || (error && error != bhttp::error::need_more)) co_return error;
        auto [read_error, count] = co_await bhttp::async_read_header(m_stream, m_buffer, parser, token);
        co_return read_error;
    }

    /// Throws std::system_error.
    asio::awaitable<beast::error_code> read_body(HeadParser& parser, std::uint64_t limit, ReceivedBody& body) {
        const auto length = parser.content_length();
        if (length && *length > limit) co_return bhttp::error::body_limit;
        if (parser.is_done()) co_return beast::error_code();
        parser.body_limit(limit);
        if (beast::iequals(parser.get()[bhttp::field::expect], "100-continue")) {
            const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
            const bool sent = co_await m_writer.write_text(go_on);
            if (!sent) co_return bhttp::error::partial_message;
        }
        m_dispensable_from = SteadyClock::now() + slow_body;
        m_stream.expires_after(m_limits.body_timeout);
        const BodyRoute route{m_stream, m_buffer, m_context.spool, m_context.spooled_bytes, m_limits.spool_bytes};
        co_return co_await receive_body(route, parser, limit, body);
    }

    /// Sends the problem and ends the connection so that the sender can read it: closing with unread data would reset
    /// the connection, and the answer would be lost.
    asio::awaitable<bool> reject(std::optional<Response> response) {
        if (!response) co_return false;
        m_close = true;
        co_await write_response(std::move(*response));
        beast::error_code ignored;
        m_stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
        std::array<char, 65536> dropped;
        m_dispensable_from = SteadyClock::now();
        m_stream.expires_after(at_most(linger_timeout));
        for (std::uint64_t total = 0; total < m_limits.drain_bytes;) {
            auto [end, count] = co_await m_stream.async_read_some(asio::buffer(dropped), token);
            if (end) break;
            total += count;
        }
        co_return false;
    }

    asio::awaitable<bool> write_answer(Answer answer) {
        if (auto* response = std::get_if<Response>(&answer)) co_return co_await write_response(std::move(*response));
        if (auto* waiting = std::get_if<Waiting>(&answer)) co_return co_await write_when_ready(*waiting);
        co_return co_await write_events(std::get<EventStream>(answer));
    }

    asio::awaitable<bool> write_when_ready(Waiting& waiting) {
        const Lasting lasting(m_context.lasting, m_client);
        // If there are too many, this one does not wait: it gets the current state.
        const auto deadline = SteadyClock::now() + (lasting.is_granted() ? waiting.limit : Milliseconds(0));
        while (true) {
            const std::uint64_t seen = m_context.changes.generation();
            std::optional<Response> response = co_await on_pool(m_context.pool, [&] { return waiting.ready(); });
            const auto left = std::chrono::ceil<Milliseconds>(deadline - SteadyClock::now());
            if (!response && (left <= Milliseconds(0) || m_context.stopping))
                response = co_await on_pool(m_context.pool, [&] { return waiting.otherwise(); });
            if (response) co_return co_await write_response(std::move(*response));
            const bool there = co_await wait_for_change(seen, left);
            if (!there) co_return false;
        }
    }

    /// The next chunk of a stream. The pool or the store may be busy for a long time, so signs of life are sent
    /// meanwhile. Nothing if the other side has closed the connection.
    asio::awaitable<std::optional<EventChunk>> next_chunk(const std::shared_ptr<EventStream>& stream,
                                                          SteadyTime& next_heartbeat) {
        PoolWork<EventChunk> work(m_context.pool, m_stream.get_executor(), [stream] { return stream->next(); });
        while (true) {
            const bool is_over = co_await work.wait(next_heartbeat);
            if (is_over) co_return work.take();
            const bool sent = co_await m_writer.write_text(sign_of_life);
            if (!sent) co_return std::nullopt;
            next_heartbeat = SteadyClock::now() + m_limits.event_heartbeat;
        }
    }

    asio::awaitable<bool> write_events(EventStream& given) {
        const Lasting lasting(m_context.lasting, m_client);
        if (!lasting.is_granted()) co_return co_await write_response(too_many_streams());
        m_close = true;
        const bool begun = co_await m_writer.write_endless(given.head);
        if (!begun || m_head) co_return false;
        const auto stream = std::make_shared<EventStream>(std::move(given));
        auto next_heartbeat = SteadyClock::now() + m_limits.event_heartbeat;
        while (!m_context.stopping) {
            const std::uint64_t seen = m_context.changes.generation();
            std::optional<EventChunk> made = co_await next_chunk(stream, next_heartbeat);
            if (!made) co_return false;
            EventChunk& chunk = *made;
            if (chunk.text.empty() && SteadyClock::now() >= next_heartbeat) chunk.text = sign_of_life;
            if (!chunk.text.empty()) {
                const bool sent = co_await m_writer.write_text(chunk.text);
                if (!sent) co_return false;
                next_heartbeat = SteadyClock::now() + m_limits.event_heartbeat;
            }
            if (chunk.last) break;
            const auto left = std::chrono::ceil<Milliseconds>(next_heartbeat - SteadyClock::now());
            const bool there = co_await wait_for_change(seen, std::max(left, Milliseconds(0)));
            if (!there) co_return false;
        }
        co_return false;
    }

    static Response too_many_streams() {
        Response response =
            finished(problem(429, "Too many streams of events are open; close one, or try again later."));
        response.headers.add("Retry-After", "10");
        return response;
    }

    /// Returns false if the other side has closed the connection meanwhile.
    asio::awaitable<bool> wait_for_change(std::uint64_t seen, Milliseconds limit) {
        if (m_read_ahead) {
            co_await m_context.changes.wait(seen, limit);
            co_return true;
        }
        const auto first = co_await (m_context.changes.wait(seen, limit) ||
                                     m_stream.socket().async_wait(tcp::socket::wait_read, token));
        if (first.index() == 0) co_return true;
        beast::error_code error;
        // Readable data means either the end of the connection or a request that was sent early.
        m_read_ahead = m_stream.socket().available(error) > 0;
        co_return !error && m_read_ahead;
    }

    asio::awaitable<bool> write_response(Response response) {
        m_read_ahead = false;
        const bool keep_alive = !m_close && !m_context.stopping && m_version == 11;
        const bool sent = co_await m_writer.write(std::move(response), m_head, keep_alive);
        co_return sent&& keep_alive;
    }

    SessionContext& m_context;
    const Limits& m_limits;
    const Seat m_seat;
    const SteadyTime m_begun = SteadyClock::now();
    std::string m_client;  ///< its address
    std::optional<SteadyTime> m_dispensable_from;
    bool m_over = false;
    beast::tcp_stream m_stream;
    ResponseWriter m_writer{m_stream, m_context.pool, m_limits.write_timeout};
    beast::flat_buffer m_buffer;
    unsigned m_version = 11;
    bool m_idle = false;
    bool m_has_asked = false;  ///< whether a first request has begun to arrive
    bool m_head = false;
    bool m_close = false;
    bool m_read_ahead = false;  ///< whether the next request has already arrived
};

}  // namespace

std::shared_ptr<Session> make_session(tcp::socket socket, Seat seat, SessionContext& context) {
    return std::make_shared<TcpSession>(std::move(socket), seat, context);
}

bool drop_idle(const std::set<Session*>& sessions) {
    Session* longest = nullptr;
    for (Session* session : sessions) {
        if (session->is_over() || session->seat() == Seat::spare || !session->dispensable_from()) continue;
        if (longest == nullptr || *session->dispensable_from() < *longest->dispensable_from()) longest = session;
    }
    if (longest == nullptr || *longest->dispensable_from() > SteadyClock::now()) return false;
    longest->drop();
    return true;
}

}  // namespace sheer::http
