#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/params/param.h"
#include "server/access/token.h"
#include "server/http/message.h"

namespace sheer::http {

using Handler = std::function<Answer(const Request&)>;

/// Answers with a body that does not change while the program runs, under an ETag made of it.
Handler always(Response response);

/// One possible answer, for the OpenAPI document.
struct Reply {
    int status = 200;
    std::string description;
    std::string media_type = "application/json";  ///< "" for none
    std::string schema;                           ///< name of a component, "" for any
    std::vector<std::string> headers;             ///< names that described_headers() knows
    std::string example;                          ///< name of an example, "" for that of the schema
};

struct HeaderField {
    std::string name;
    std::string summary;
};

/// A call of the service. The OpenAPI document and the checks of the query are made from this description.
struct Route {
    std::string method;   ///< GET also answers HEAD
    std::string pattern;  ///< "/api/v1/reports/{id}"; a {name} stands for one segment
    std::string id;       ///< operationId; "" keeps it out of the OpenAPI document
    std::string summary;
    std::string description;  ///< what the summary leaves out, in sentences; "" for nothing
    std::vector<Param> query;
    std::vector<HeaderField> headers;
    std::string body_schema;  ///< component that the JSON body must match; "" for no JSON body
    std::vector<Reply> replies;
    Handler handle;
    /// The answer, if it is in memory and is what `handle` would answer now. Must not wait. Null: it never is.
    std::function<std::optional<Response>(const Request&)> known = {};
    std::vector<std::string> body_types;  ///< media types of a body that is not JSON
    std::uint64_t body_bytes = 0;         ///< longest body; 0 for the service's general limit
    Lane lane = Lane::pool;
    bool is_probe = false;  ///< sent by machines that know only an address, so it is answered for any Host
    /// The current ETag of the target; throws Problem (404) if there is no such target. Only for calls that change
    /// something: their preconditions are compared with it.
    std::function<std::string(const Request&)> etag;
    std::vector<std::string> repeatable = {};  ///< texts of `query` that may be given several times: arrays of texts
    int wrong_query_status = 400;  ///< status of the answer to a query with wrong, missing or unknown fields
    std::string tag;               ///< its group in the OpenAPI document
    /// The token that it takes, if tokens are asked for. Unless a route says otherwise: read, if it changes nothing,
    /// and submit.
    std::optional<Scope> scope = {};

    Scope needed_scope() const;
};

struct Match {
    const Route* route = nullptr;                    ///< null if none matches
    std::map<std::string, std::string> path_values;  ///< decoded
    std::vector<std::string> allowed;                ///< methods that the path supports; empty if there is no such path
};

class Router {
  public:
    void add(std::vector<Route> routes);
    Match match(std::string_view method, std::string_view path) const;
    const std::vector<Route>& routes() const { return m_routes; }

  private:
    std::vector<Route> m_routes;
    std::vector<std::vector<std::string>> m_patterns;  ///< the segments of each route's
};

/// Reads `query` as `fields` describe it; numbers are given as text. The fields in `repeatable` become arrays,
/// without empty texts. Throws Problem (`wrong_status`) with every wrong field, or Problem (400) if it cannot be read
/// at all.
nlohmann::json read_query(std::string_view query, const std::vector<Param>& fields, int wrong_status = 400,
                          const std::vector<std::string>& repeatable = {});

}  // namespace sheer::http
