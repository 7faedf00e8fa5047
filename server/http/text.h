#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheer::http {

bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Without the spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The parts between `separator`, trimmed.
std::vector<std::string_view> split(std::string_view text, char separator);

/// Without its %XX escapes, or nothing if one is broken; `plus_is_space` as in a query.
std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space);

/// The names and values of a query, decoded, or nothing if an escape is broken.
std::optional<std::vector<std::pair<std::string, std::string>>> query_pairs(std::string_view query);

/// The seconds that a Prefer field asks to wait (RFC 7240); nothing if it does not, or not in whole seconds.
std::optional<int> preferred_wait_s(std::string_view prefer);

/// Whether an If-None-Match field names `etag` (RFC 9110, weak comparison).
bool names_etag(std::string_view if_none_match, std::string_view etag);

/// Whether a Content-Type is JSON: application/json or application/...+json.
/// The type of a Content-Type in lower case, without parameters.
std::string media_type_of(std::string_view content_type);
bool is_json_type(std::string_view content_type);

/// The name in a Host field, in lower case and without its port; IPv6 addresses keep their brackets.
std::string host_name(std::string_view host);

/// A server-sent event (WHATWG HTML, 9.2). `data` must have no line ends.
std::string event_text(std::int64_t id, std::string_view event, std::string_view data);

/// Opaque text for the place after report `id` in the list, and back; nothing if it is not such a text.
std::string cursor_after(std::string_view id);
std::optional<std::string> id_of_cursor(std::string_view cursor);

}  // namespace sheer::http
