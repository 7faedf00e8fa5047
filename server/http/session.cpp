#include "server/http/session.h"

#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <ctime>

#include "server/http/application.h"
#include "server/http/pool_work.h"
#include "server/http/problem.h"
#include "server/http/request_head.h"
#include "server/http/spooled_body.h"

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
// The part of a body that is read and sent at a time.
constexpr std::uint64_t piece_bytes = 64 << 10;
// A longer body goes to a file until it is complete.
constexpr std::uint64_t longest_body_in_memory = 1 << 20;
// For a probe's request on a connection beyond the limit.
constexpr std::chrono::seconds spare_timeout{2};

/// RFC 9110, 5.6.7.
std::string http_date() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 40> text;
    return {text.data(), std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc)};
}

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
    using HeadParser = bhttp::request_parser<bhttp::empty_body>;

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
        std::optional<SpooledBody> spooled;
        std::optional<Response> wrong_body;
        try {
            const beast::error_code body_error =
                co_await read_body(parser, handling.body_bytes.value_or(m_limits.body_bytes), request.body, spooled);
            if (body_error) co_return co_await reject(problem_of(body_error));
        } catch (const std::system_error& error) {
            wrong_body = no_room_for_body(request, error);
        }
        if (!wrong_body && spooled && m_context.spooled_bytes > m_limits.spool_bytes) wrong_body = too_many_bodies();
        if (wrong_body) {
            spooled.reset();
            co_return co_await reject(std::move(wrong_body));
        }
        m_dispensable_from.reset();
        Answer answer = co_await make_answer(std::move(request), handling.lane, spooled);
        spooled.reset();
        co_return co_await write_answer(std::move(answer));
    }

    asio::awaitable<Answer> make_answer(Request request, Lane lane, const std::optional<SpooledBody>& spooled) {
        if (lane == Lane::at_once && !spooled) co_return m_context.answer(std::move(request));
        asio::thread_pool& pool = lane == Lane::specs ? m_context.spec_pool : m_context.pool;
        co_return co_await on_pool(pool, [&] {
            try {
                if (spooled) request.body = spooled->text();
            } catch (const std::system_error& error) {
                return Answer(no_room_for_body(request, error));
            }
            return m_context.answer(std::move(request));
        });
    }

    static Response no_room_for_body(const Request& request, const std::system_error& error) {
        spdlog::error("{} {}: {}", request.method, request.target, error.what());
        return problem(507, "There is no room for the body.");
    }

    static Response too_many_bodies() {
        Response response = problem(503, "Too many long bodies are on their way; try again later.");
        response.headers.add("Retry-After", "10");
        return response;
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
        auto [error, count] = co_await bhttp::async_read_header(m_stream, m_buffer, parser, token);
        co_return error;
    }

    /// Into `body`, or into a file if it is long. Throws std::system_error.
    asio::awaitable<beast::error_code> read_body(HeadParser& parser, std::uint64_t limit, std::string& body,
                                                 std::optional<SpooledBody>& spooled) {
        const auto length = parser.content_length();
        if (length && *length > limit) co_return bhttp::error::body_limit;
        if (parser.is_done()) co_return beast::error_code();
        parser.body_limit(limit);
        if (beast::iequals(parser.get()[bhttp::field::expect], "100-continue")) {
            const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
            const bool sent = co_await write_text(go_on);
            if (!sent) co_return bhttp::error::partial_message;
        }
        m_dispensable_from = SteadyClock::now() + slow_body;
        m_stream.expires_after(m_limits.body_timeout);
        if (length.value_or(parser.chunked() ? limit : 0) > longest_body_in_memory) {
            spooled.emplace(m_context.spool, m_context.spooled_bytes);
            co_return co_await read_long_body(parser, *spooled);
        }
        bhttp::request_parser<bhttp::string_body> whole(std::move(parser));
        auto [error, count] = co_await bhttp::async_read(m_stream, m_buffer, whole, token);
        body = std::move(whole.get().body());
        co_return error;
    }

    /// Ends early, without an error, if all long bodies together become too many.
    asio::awaitable<beast::error_code> read_long_body(HeadParser& parser, SpooledBody& spooled) {
        bhttp::request_parser<bhttp::buffer_body> pieces(std::move(parser));
        std::string piece(piece_bytes, '\0');
        while (!pieces.is_done() && m_context.spooled_bytes <= m_limits.spool_bytes) {
            pieces.get().body().data = piece.data();
            pieces.get().body().size = piece.size();
            auto [error, count] = co_await bhttp::async_read(m_stream, m_buffer, pieces, token);
            if (error && error != bhttp::error::need_buffer) co_return error;
            spooled.append(std::string_view(piece).substr(0, piece.size() - pieces.get().body().size));
        }
        co_return beast::error_code();
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
            const bool sent = co_await write_text(sign_of_life);
            if (!sent) co_return std::nullopt;
            next_heartbeat = SteadyClock::now() + m_limits.event_heartbeat;
        }
    }

    asio::awaitable<bool> write_events(EventStream& given) {
        const Lasting lasting(m_context.lasting, m_client);
        if (!lasting.is_granted()) co_return co_await write_response(too_many_streams());
        m_close = true;
        const bool begun = co_await write_stream_head(given.head);
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
                const bool sent = co_await write_text(chunk.text);
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

    template <typename Body>
    void fill_head(bhttp::response<Body>& message, const Response& response) {
        message.result(static_cast<unsigned>(response.status));
        message.reason(status_phrase(response.status));
        message.version(11);
        for (const auto& [name, value] : response.headers.fields()) message.insert(name, value);
        message.set(bhttp::field::date, http_date());
        message.keep_alive(!m_close && !m_context.stopping && m_version == 11);
    }

    asio::awaitable<bool> write_response(Response response) {
        m_read_ahead = false;
        const auto* content = std::get_if<ContentPtr>(&response.body);
        if (content) co_return co_await write_content(response, **content);
        std::string& text = std::get<std::string>(response.body);
        const bool has_body = response.status != 204 && response.status != 304;
        if (m_head || !has_body)
            co_return co_await write_empty(response, has_body ? std::optional(text.size()) : std::nullopt);
        bhttp::response<bhttp::string_body> message;
        fill_head(message, response);
        message.body() = std::move(text);
        message.prepare_payload();
        co_return co_await write_message(message);
    }

    /// Reading from a store may take a long time, so the pool reads one piece at a time.
    asio::awaitable<bool> write_content(const Response& response, const Content& content) {
        const std::uint64_t size = content.size_bytes();
        bhttp::response<bhttp::empty_body> message;
        fill_head(message, response);
        message.content_length(size);
        if (m_head) co_return co_await write_message(message);
        const bool begun = co_await send(message);
        if (!begun) co_return false;
        std::string piece;
        for (std::uint64_t done = 0; done < size; done += piece.size()) {
            piece.resize(std::min<std::uint64_t>(size - done, piece_bytes));
            co_await on_pool(m_context.pool, [&] { content.read(done, piece); });
            const bool sent = co_await write_text(piece);
            if (!sent) co_return false;
        }
        co_return message.keep_alive();
    }

    /// A head without a body; `length` is the length that the body would have.
    asio::awaitable<bool> write_empty(const Response& response, std::optional<std::uint64_t> length) {
        bhttp::response<bhttp::empty_body> message;
        fill_head(message, response);
        if (length) message.content_length(*length);
        co_return co_await write_message(message);
    }

    asio::awaitable<bool> write_stream_head(const Response& head) {
        bhttp::response<bhttp::empty_body> message;
        fill_head(message, head);
        co_return co_await send(message);
    }

    /// Returns whether the connection can be used again.
    template <typename Body>
    asio::awaitable<bool> write_message(bhttp::response<Body>& message) {
        const bool sent = co_await send(message);
        co_return sent&& message.keep_alive();
    }

    template <typename Body>
    asio::awaitable<bool> send(bhttp::response<Body>& message) {
        bhttp::response_serializer<Body> serializer(message);
        // Others have their turn in between.
        serializer.limit(piece_bytes);
        while (!serializer.is_done()) {
            m_stream.expires_after(m_limits.write_timeout);
            auto [error, count] = co_await bhttp::async_write_some(m_stream, serializer, token);
            if (error) co_return false;
        }
        m_stream.expires_never();
        co_return true;
    }

    asio::awaitable<bool> write_text(std::string_view text) {
        while (!text.empty()) {
            m_stream.expires_after(m_limits.write_timeout);
            auto [error, count] = co_await m_stream.async_write_some(asio::buffer(text, piece_bytes), token);
            if (error) co_return false;
            text.remove_prefix(count);
        }
        m_stream.expires_never();
        co_return true;
    }

    SessionContext& m_context;
    const Limits& m_limits;
    const Seat m_seat;
    const SteadyTime m_begun = SteadyClock::now();
    std::string m_client;  ///< its address
    std::optional<SteadyTime> m_dispensable_from;
    bool m_over = false;
    beast::tcp_stream m_stream;
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
