// The server with real sockets and a slow store.
#include "server/http/server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <set>
#include <thread>

#include "memory_state.h"
#include "renderer/core/sha256.h"
#include "server/http/application.h"
#include "server/http/service.h"
#include "server/jobs/report_id.h"

namespace sheer::http::server_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto patience = 30s;

/// A connection to the server.
class Client {
  public:
    explicit Client(const Endpoint& endpoint) : m_socket(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(endpoint.port);
        inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr);
        if (connect(m_socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("cannot connect");
    }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    ~Client() { close(m_socket); }

    void send(const std::string& method, const std::string& target, const std::string& body = "",
              const std::string& more = "") const {
        send_text(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more +
                  "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    }

    void send_text(const std::string& text) const {
        for (std::size_t sent = 0; sent < text.size();) {
            const ssize_t count = write(m_socket, text.data() + sent, text.size() - sent);
            ASSERT_GT(count, 0);
            sent += static_cast<std::size_t>(count);
        }
    }

    /// Reads until `enough` has arrived, or the server ends the connection. Returns everything read so far.
    const std::string& read_until(const std::string& enough) {
        const auto deadline = std::chrono::steady_clock::now() + patience;
        std::size_t from = m_read_to;
        while (m_text.find(enough, from) == std::string::npos) {
            pollfd waiting{m_socket, POLLIN, 0};
            if (poll(&waiting, 1, 100) == 1) {
                std::array<char, 4096> bytes;
                const ssize_t count = read(m_socket, bytes.data(), bytes.size());
                if (count <= 0) return m_text;
                m_text.append(bytes.data(), static_cast<std::size_t>(count));
            }
            if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("no answer; so far: " + m_text);
        }
        m_read_to = m_text.find(enough, from) + enough.size();
        return m_text;
    }

    const std::string& read_all() { return read_until(std::string(64, '\0')); }

  private:
    int m_socket;
    std::string m_text;
    std::size_t m_read_to = 0;
};

class ServerTest : public testing::Test {
  protected:
    ServerTest() {
        m_state->on_call = [this] { on_call(); };
        m_service.clock = system_now_ms;
        m_service.list_devices = [] { return json::array(); };
        m_service.pixel = [](const std::string&, const PixelPlace&) { return PixelAnswer{.json = "{}"}; };
        m_service.check_upload = [](const std::string&, const std::string&) {
            return UploadVerdict{"", json::object()};
        };
        m_connections = std::thread([this] { m_server.run(); });
    }

    ~ServerTest() override {
        m_is_stuck = false;
        kill(getpid(), SIGTERM);
        m_connections.join();
    }

    std::string ask(const std::string& method, const std::string& target, const std::string& body = "",
                    const std::string& more = "") {
        Client client(m_server.endpoint());
        client.send(method, target, body, more);
        return client.read_all();
    }

    static json empty_run() {
        return {{"point", json::object()},
                {"reference", {{"method", "exact"}, {"images", json::object()}}},
                {"results", json::array()}};
    }

    std::string make_done() {
        const std::string picture = "a picture", sha256 = sha256_hex(picture);
        const json image = {{"sha256", sha256}, {"url", "u"}, {"media_type", "image/png"}};
        const json spec = {{"methods", {"b2f"}}, {"image", {{"width", 4}, {"height", 4}}}};
        const NewReport report{.id = m_ids.next(), .spec = spec.dump(), .spec_sha256 = "of the spec"};
        m_store.queue().submit(report, {100});
        const FinishedReport finished{
            .report = {{"id", report.id}, {"spec", spec}, {"runs", json::array({empty_run()})}},
            .blobs = {{sha256, "image/png"}},
            .read_blob = [picture](const std::string&) { return picture; }};
        m_store.queue().commit(m_store.queue().lease("worker").value(), finished);
        return report.id;
    }

    void on_call() {
        {
            const std::lock_guard lock(m_mutex);
            m_callers.insert(std::this_thread::get_id());
        }
        while (m_is_stuck) std::this_thread::sleep_for(1ms);
    }

    bool was_called_by(std::thread::id caller) {
        const std::lock_guard lock(m_mutex);
        return m_callers.contains(caller);
    }

    std::atomic<bool> m_is_stuck = false;  ///< callers of the store wait
    std::mutex m_mutex;
    std::set<std::thread::id> m_callers;  ///< guarded by m_mutex
    std::shared_ptr<test::MemoryState> m_state = test::make_memory_state();
    test::MemoryStore m_store{m_state, {}, system_now_ms};
    ReportIds m_ids{system_now_ms};
    Service m_service{.store = m_store, .ids = m_ids, .clock = {}, .list_devices = {}};
    const Router m_router = make_router(m_service);
    const Application m_application{make_guard(true, {}), m_router};
    const Limits m_limits{.threads = 1, .spool_bytes = 8 << 20, .event_heartbeat = 50ms};
    Server m_server{{.port = 0},
                    m_limits,
                    {.answer = [this](Request request) { return m_application.answer(std::move(request)); },
                     .handling = [this](std::string_view method,
                                        std::string_view target) { return m_application.handling(method, target); },
                     .changes = m_store.watch(),
                     .reload = [] {}}};
    std::thread m_connections;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(ServerTest, TheStoreIsNotCalledOnTheThreadOfTheConnections) {
    const std::string id = make_done(), picture = sha256_hex("a picture"), upload = sha256_hex("an upload");
    const std::string spec = R"({"scene": {"type": "quads"}, "methods": ["b2f"]})";
    EXPECT_THAT(ask("POST", "/api/v1/assets", "an upload", "Content-Type: image/png\r\n"), HasSubstr(" 201 "));
    EXPECT_THAT(ask("POST", "/api/v1/reports", spec), HasSubstr(" 202 "));
    EXPECT_THAT(ask("POST", "/api/v1/reports", spec, "Prefer: wait=1\r\n"), HasSubstr(" 202 "));
    {
        const std::lock_guard lock(m_mutex);
        m_callers.clear();
    }
    std::size_t asked = 0;
    for (const Route& route : m_router.routes()) {
        if (route.method != "GET") continue;
        std::string target = replaced(replaced(route.pattern, "{id}", id), "{sha256}",
                                      route.pattern.find("assets") == std::string::npos ? picture : upload);
        if (target.ends_with("/pixel")) target += "?x=0&y=0";
        if (target.ends_with("/diff")) target += "?against=" + id;
        EXPECT_THAT(ask("GET", target), HasSubstr("HTTP/1.1 ")) << target;
        ++asked;
    }
    EXPECT_GT(asked, 20u);
    EXPECT_THAT(ask("DELETE", "/api/v1/reports/" + id), HasSubstr(" 204 "));
    EXPECT_THAT(ask("DELETE", "/api/v1/assets/" + upload), HasSubstr(" 204 "));
    EXPECT_FALSE(m_callers.empty());
    EXPECT_FALSE(was_called_by(m_connections.get_id()));
}

TEST_F(ServerTest, APictureIsSentCompletely) {
    make_done();
    const std::string path = "/api/v1/blobs/" + sha256_hex("a picture");
    EXPECT_THAT(ask("GET", path),
                testing::AllOf(HasSubstr("Content-Length: 9\r\n"), testing::EndsWith("\r\n\r\na picture")));
    EXPECT_THAT(ask("HEAD", path), testing::AllOf(HasSubstr("Content-Length: 9\r\n"), testing::EndsWith("\r\n\r\n")));
}

/// No two pieces of it are equal.
std::string long_text(std::size_t bytes) {
    std::string text;
    while (text.size() < bytes) text += std::to_string(text.size()) + ",";
    text.resize(bytes);
    return text;
}

TEST_F(ServerTest, ALongBodyArrivesWhole) {
    const std::string type = "Content-Type: image/png\r\n", body = long_text((3 << 20) + 7);
    EXPECT_THAT(ask("POST", "/api/v1/assets", body, type),
                testing::AllOf(HasSubstr(" 201 "), HasSubstr(sha256_hex(body))));
    EXPECT_THAT(ask("GET", "/api/v1/assets/" + sha256_hex(body)), testing::EndsWith("\r\n\r\n" + body));
    const std::string other = long_text((1 << 20) + 1);
    std::string chunks;
    for (std::size_t at = 0; at < other.size(); at += 100'000) {
        const std::string chunk = other.substr(at, 100'000);
        std::array<char, 20> length;
        std::snprintf(length.data(), length.size(), "%zx\r\n", chunk.size());
        chunks += length.data() + chunk + "\r\n";
    }
    Client client(m_server.endpoint());
    client.send_text("POST /api/v1/assets HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + type +
                     "Transfer-Encoding: chunked\r\n\r\n" + chunks + "0\r\n\r\n");
    EXPECT_THAT(client.read_all(), testing::AllOf(HasSubstr(" 201 "), HasSubstr(sha256_hex(other))));
}

TEST_F(ServerTest, LongBodiesOnTheirWayAreLimitedTogether) {
    const std::string head =
        "POST /api/v1/assets HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/png\r\n"
        "Content-Length: 5000000\r\n\r\n";
    Client second(m_server.endpoint());
    {
        Client first(m_server.endpoint());
        first.send_text(head + long_text(4'900'000));
        second.send_text(head + long_text(4'900'000));
        EXPECT_THAT(second.read_all(), testing::AllOf(HasSubstr(" 503 "), HasSubstr("Retry-After: 10")));
        EXPECT_THAT(ask("GET", "/healthz"), HasSubstr("200 OK"));
    }
    // The first gave up, which makes room.
    const std::string body = long_text(4'900'001);
    std::string answer;
    for (int i = 0; i < 100 && answer.find(" 201 ") == std::string::npos; ++i)
        answer = ask("POST", "/api/v1/assets", body, "Content-Type: image/png\r\n");
    EXPECT_THAT(answer, HasSubstr(sha256_hex(body)));
}

TEST_F(ServerTest, ABlockedStoreDelaysOnlyRequestsThatNeedIt) {
    const NewReport report{.id = m_ids.next(), .spec = "{}", .spec_sha256 = ""};
    m_store.queue().submit(report, {100});
    Client stream(m_server.endpoint()), reader(m_server.endpoint());
    stream.send("GET", "/api/v1/reports/" + report.id + "/events");
    EXPECT_THAT(stream.read_until("event: progress"), HasSubstr("200 OK"));
    // From here on calls of the store do not return, and the only thread that makes answers is blocked.
    m_is_stuck = true;
    reader.send("GET", "/api/v1/reports");
    for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(ask("GET", "/healthz"), HasSubstr("200 OK"));
        stream.read_until(":\n\n");
    }
    EXPECT_TRUE(m_is_stuck);
    m_is_stuck = false;
    EXPECT_THAT(reader.read_all(), HasSubstr("200 OK"));
    m_store.reports().remove(report.id);
    EXPECT_THAT(stream.read_until("event: cancelled"), HasSubstr("event: cancelled"));
}

}  // namespace
}  // namespace sheer::http::server_test
