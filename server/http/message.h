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
    const std::vector<std::pair<std::string, std::string>>& fields() const { return m_fields; }

  private:
    std::vector<std::pair<std::string, std::string>> m_fields;
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
