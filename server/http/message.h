#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace sheer::http {

/// Header fields in their order; names match without regard to case.
class Headers {
  public:
    void add(std::string name, std::string value) { m_fields.emplace_back(std::move(name), std::move(value)); }
    /// The first value, or nothing.
    std::optional<std::string> find(std::string_view name) const;
    bool contains(std::string_view name) const { return find(name).has_value(); }
    /// The values of all fields of this name as one list (RFC 9110, 5.3), or nothing.
    std::optional<std::string> joined(std::string_view name) const;
    std::size_t count(std::string_view name) const;
    /// In place of all fields of this name.
    void set(std::string_view name, std::string value);
    const std::vector<std::pair<std::string, std::string>>& fields() const { return m_fields; }

  private:
    std::vector<std::pair<std::string, std::string>> m_fields;
};

/// Who makes an answer. What only says that the service lives shares nothing with those who work.
enum class Lane {
    at_once,  ///< the thread of the connections: nothing that waits for anything
    pool,     ///< the threads for answers
    specs     ///< threads of their own for specs: to check one can take seconds
};

/// How a request is treated, as far as its method and target say.
struct Handling {
    std::optional<std::uint64_t> body_bytes;  ///< the longest body, or nothing for the general limit
    Lane lane = Lane::pool;
    bool is_probe = false;  ///< answered also where there is no room for anything else
};

struct Request {
    std::string method;
    std::string target;  ///< path and query, as sent
    Headers headers;
    std::string body;
    std::map<std::string, std::string> path_values;   ///< of the route's {names}, decoded
    nlohmann::json query = nlohmann::json::object();  ///< as the route describes it, checked, defaults filled in
};

struct Response {
    int status = 200;
    Headers headers;
    /// The bytes, or the file that holds them.
    std::variant<std::string, std::filesystem::path> body;
};

/// A response that is given when it is ready. Both functions run on the pool; `ready` is asked again after each change
/// in the store.
struct Waiting {
    std::chrono::milliseconds limit{};
    std::function<std::optional<Response>()> ready;
    std::function<Response()> otherwise;  ///< when the limit has passed or the service stops
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
