#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "server/jobs/content.h"

namespace sheer::http {

/// Header fields in order; the case of names is ignored.
class Headers {
  public:
    void add(std::string name, std::string value) { m_fields.emplace_back(std::move(name), std::move(value)); }
    /// The first value, or nothing.
    std::optional<std::string> find(std::string_view name) const;
    bool contains(std::string_view name) const { return find(name).has_value(); }
    /// The values of all fields of this name as one list (RFC 9110, 5.3), or nothing.
    std::optional<std::string> joined(std::string_view name) const;
    std::size_t count(std::string_view name) const;
    /// Replaces all fields of this name.
    void set(std::string_view name, std::string value);
    const std::vector<std::pair<std::string, std::string>>& fields() const { return m_fields; }

  private:
    std::vector<std::pair<std::string, std::string>> m_fields;
};

/// The threads that make an answer. Answers that only say that the service is alive share no threads with work.
enum class Lane {
    at_once,  ///< the thread of the connections: only for work that never waits
    pool,     ///< the threads for answers
    specs     ///< separate threads for specs, since checking one can take seconds
};

/// How a request is treated, based on its method and target.
struct Handling {
    std::optional<std::uint64_t> body_bytes;  ///< the longest body, or nothing for the general limit
    Lane lane = Lane::pool;
    bool is_probe = false;      ///< answered even if there is no room for anything else
    bool may_be_known = false;  ///< its answer may be in memory; then it is sent by the thread of the connections
};

struct Request {
    std::string method;
    std::string target;  ///< path and query, as sent
    Headers headers;
    std::string body;
    std::map<std::string, std::string> path_values;  ///< of the route's {names}, decoded
    nlohmann::json query =
        nlohmann::json::object();  ///< checked against the route's description, with defaults filled in
};

struct Response {
    int status = 200;
    Headers headers;
    /// The bytes, or the object that holds them.
    std::variant<std::string, ContentPtr> body;
};

/// A response that is sent when it is ready. Both functions run on the pool; `ready` is called again after each change
/// in the store.
struct Waiting {
    std::chrono::milliseconds limit{};
    std::function<std::optional<Response>()> ready;
    std::function<Response()> otherwise;  ///< if the limit has passed or the service stops
};

struct EventChunk {
    std::string text;  ///< may be empty
    bool last = false;
};

/// Server-sent events. `next` runs on the pool, first at once and then after each change in the store.
struct EventStream {
    Response head;
    std::function<EventChunk()> next;
};

using Answer = std::variant<Response, Waiting, EventStream>;

Response json_response(int status, const nlohmann::json& body);
Response text_response(int status, std::string body, std::string media_type);

}  // namespace sheer::http
