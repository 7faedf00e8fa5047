#include "server/http/path_prefix.h"

#include <algorithm>

#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

/// The index after the JSON string that begins at `begin` with a quote.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
    std::size_t at = begin + 1;
    while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
    return std::min(at + 1, text.size());
}

std::size_t after_spaces(std::string_view text, std::size_t at) {
    return std::min(text.find_first_not_of(" \n\r\t", at), text.size());
}

/// The index after the object without inner objects that begins at `at`, or `at` if there is none.
std::size_t end_of_flat_object(std::string_view text, std::size_t at) {
    if (at >= text.size() || text[at] != '{') return at;
    while (at < text.size() && text[at] != '}') at = text[at] == '"' ? end_of_string(text, at) : at + 1;
    return std::min(at + 1, text.size());
}

/// Whether a JSON text begins with the path of a call or of a part of the page.
bool is_own_path(std::string_view text) {
    return text.starts_with("\"/api/v1/") || text.starts_with("\"/thumbnails/");
}

}  // namespace

std::string json_with_prefix(std::string_view text, std::string_view prefix) {
    std::string all;
    all.reserve(text.size());
    std::size_t copied = 0, at = 0;
    while ((at = text.find('"', at)) != std::string_view::npos) {
        const std::size_t end = end_of_string(text, at);
        const std::string_view name = text.substr(at, end - at);
        at = after_spaces(text, end);
        if (at >= text.size() || text[at] != ':') continue;
        at = after_spaces(text, at + 1);
        if (name == R"("tags")") at = end_of_flat_object(text, at);
        if ((name != R"("url")" && name != R"("picture")") || !is_own_path(text.substr(at))) continue;
        all += text.substr(copied, at + 1 - copied);
        all += prefix;
        copied = at + 1;
        at = end_of_string(text, at);
    }
    all += text.substr(copied);
    return all;
}

std::string wrong_path_prefix(std::string_view prefix) {
    if (prefix.empty()) return "";
    if (!prefix.starts_with('/') || prefix.ends_with('/')) return "must begin with a slash and not end with one";
    if (prefix.find("//") != std::string_view::npos || with_escapes(prefix) != prefix ||
        prefix.find_first_of("?%\"\\") != std::string_view::npos)
        return "must be a path of plain segments, such as /sheer";
    return "";
}

std::string_view PathPrefix::stripped(std::string_view target) const {
    if (m_prefix.empty() || !target.starts_with(m_prefix)) return target;
    const std::string_view rest = target.substr(m_prefix.size());
    return rest.starts_with('/') ? rest : target;
}

std::optional<Response> PathPrefix::redirection(std::string_view target) const {
    if (m_prefix.empty() || target.substr(0, target.find('?')) != m_prefix) return std::nullopt;
    Response response{.status = 308, .headers = {}, .body = {}};
    response.headers.add("Location", m_prefix + "/");
    return response;
}

Response PathPrefix::put_before(Response response) const {
    if (m_prefix.empty()) return response;
    const auto location = response.headers.find("Location");
    if (location && response.status != 308) response.headers.set("Location", m_prefix + *location);
    auto* text = std::get_if<std::string>(&response.body);
    if (text != nullptr && is_json_type(response.headers.find("Content-Type").value_or("")))
        *text = json_with_prefix(*text, m_prefix);
    return response;
}

}  // namespace sheer::http
