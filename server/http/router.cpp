#include "server/http/router.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "renderer/core/sha256.h"
#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

using nlohmann::json;

namespace {

using Segments = std::vector<std::string>;

/// The values of the {names}, or nothing if the path does not fit.
std::optional<std::map<std::string, std::string>> fit(const Segments& pattern, const Segments& path) {
    if (pattern.size() != path.size()) return std::nullopt;
    for (std::size_t i = 0; i < pattern.size(); ++i)
        if (pattern[i].starts_with('{') ? path[i].empty() : path[i] != pattern[i]) return std::nullopt;
    std::map<std::string, std::string> values;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i].starts_with('{')) {
            values[pattern[i].substr(1, pattern[i].size() - 2)] = path[i];
        }
    }
    return values;
}

/// The values of a query are texts; if a number is expected, a text that reads as a whole number is one.
json typed(const std::string& text, const std::vector<Param>& fields, const std::string& name) {
    const auto field = std::ranges::find(fields, name, &Param::name);
    if (field == fields.end() || field->kind != Param::Kind::integer) return text;
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return text;
    return number;
}

}  // namespace

Handler always(Response response) {
    const std::string hash = sha256_hex(std::get<std::string>(response.body));
    response.headers.add("ETag", fmt::format("\"{}\"", hash.substr(0, 32)));
    response.headers.add("Cache-Control", "no-cache");
    return [response = std::move(response)](const Request&) { return response; };
}

Scope Route::needed_scope() const {
    if (scope) return *scope;
    return is_probe ? Scope::none : is_safe(method) ? Scope::read : Scope::submit;
}

void Router::add(std::vector<Route> routes) {
    for (Route& route : routes) {
        m_patterns.push_back(*path_segments(route.pattern));
        m_routes.push_back(std::move(route));
    }
}

Match Router::match(std::string_view method, std::string_view path) const {
    Match match;
    const auto segments = path_segments(path);
    if (!segments) return match;
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    for (std::size_t i = 0; i < m_routes.size(); ++i) {
        const Route& route = m_routes[i];
        auto values = fit(m_patterns[i], *segments);
        if (!values) continue;
        match.allowed.push_back(route.method);
        if (route.method == "GET") match.allowed.emplace_back("HEAD");
        if (route.method != wanted) continue;
        match.route = &route;
        match.path_values = std::move(*values);
    }
    if (!match.allowed.empty()) match.allowed.emplace_back("OPTIONS");
    return match;
}

json read_query(std::string_view query, const std::vector<Param>& fields, int wrong_status,
                const std::vector<std::string>& repeatable) {
    if (query.empty() && fields.empty()) return json::object();
    const auto pairs = query_pairs(query);
    if (!pairs) throw Problem(400, "The query has a malformed percent escape.");
    json values = json::object();
    std::vector<FieldError> errors;
    std::map<std::string, json> repeated;
    for (const std::string& name : repeatable) repeated[name] = json::array();
    for (const auto& [name, text] : *pairs) {
        if (const auto field = repeated.find(name); field != repeated.end()) {
            if (!text.empty()) field->second.push_back(text);
            read_fields({{name, text}}, "", {*std::ranges::find(fields, name, &Param::name)}, errors);
            continue;
        }
        if (values.contains(name)) errors.push_back({(json::json_pointer() / name).to_string(), "is given twice"});
        values[name] = typed(text, fields, name);
    }
    json read_values = read_fields(values, "", fields, errors);
    if (!errors.empty()) throw Problem(wrong_status, "The query is wrong.", errors);
    for (const auto& [name, texts] : repeated) read_values[name] = texts;
    return read_values;
}

}  // namespace sheer::http
