#include "server/http/router.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

using nlohmann::json;

namespace {

/// The values of the {names}, or nothing if the path does not fit.
std::optional<std::map<std::string, std::string>> fit(std::string_view pattern, std::string_view path) {
    const auto wanted = split(pattern, '/'), given = split(path, '/');
    if (wanted.size() != given.size()) return std::nullopt;
    std::map<std::string, std::string> values;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto decoded = percent_decoded(given[i], false);
        if (!decoded) return std::nullopt;
        if (wanted[i].starts_with('{')) {
            if (decoded->empty()) return std::nullopt;
            values[std::string(wanted[i].substr(1, wanted[i].size() - 2))] = *decoded;
        } else if (*decoded != wanted[i]) {
            return std::nullopt;
        }
    }
    return values;
}

/// A query holds texts; what reads as a whole number is one where a number is wanted.
json typed(const std::string& text, const std::vector<Param>& fields, const std::string& name) {
    const auto field = std::ranges::find(fields, name, &Param::name);
    if (field == fields.end() || field->kind != Param::Kind::integer) return text;
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return text;
    return number;
}

}  // namespace

void Router::add(std::vector<Route> routes) {
    std::ranges::move(routes, std::back_inserter(m_routes));
}

Match Router::match(std::string_view method, std::string_view path) const {
    Match match;
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    for (const Route& route : m_routes) {
        auto values = fit(route.pattern, path);
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

json read_query(std::string_view query, const std::vector<Param>& fields, int wrong_status) {
    const auto pairs = query_pairs(query);
    if (!pairs) throw Problem(400, "The query has a broken percent escape.");
    json values = json::object();
    std::vector<FieldError> errors;
    for (const auto& [name, text] : *pairs) {
        if (values.contains(name)) errors.push_back({fmt::format("/{}", pointer_token(name)), "is given twice"});
        values[name] = typed(text, fields, name);
    }
    json read_values = read_fields(values, "", fields, errors);
    if (!errors.empty()) throw Problem(wrong_status, "The query is wrong.", errors);
    return read_values;
}

}  // namespace sheer::http
