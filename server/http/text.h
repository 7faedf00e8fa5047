#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheer::http {

/// `text` without spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The trimmed parts between separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// `text` with escapes for bytes that are not ASCII, and optionally for the other characters that are not allowed in a
/// path or query: URLs are in ASCII, but browsers and people send other characters too.
std::string with_ascii_only(std::string_view text);
std::string with_escapes(std::string_view text);

/// The decoded segments of an absolute path; nothing if it is not one or an escape is malformed. "/" has no segments.
std::optional<std::vector<std::string>> path_segments(std::string_view path);

/// The decoded names and values of a query, or nothing if an escape is malformed.
std::optional<std::vector<std::pair<std::string, std::string>>> query_pairs(std::string_view query);

/// The seconds to wait according to a Prefer field (RFC 7240); nothing if it has no wait, or not in whole seconds.
std::optional<int> preferred_wait_s(std::string_view prefer);

/// Whether an If-None-Match field names `etag` (RFC 9110, weak comparison).
bool names_etag(std::string_view if_none_match, std::string_view etag);

/// Whether a Content-Type is JSON: application/json or application/...+json.
/// The type of a Content-Type in lower case, without parameters.
std::string media_type_of(std::string_view content_type);
bool is_json_type(std::string_view content_type);

/// The name in a Host field, in lower case and without its port; IPv6 addresses keep their brackets.
std::string host_name(std::string_view host);

/// A server-sent event (WHATWG HTML, 9.2). `data` must not contain line breaks.
std::string event_text(std::int64_t id, std::string_view event, std::string_view data);

/// Opaque text for the position after report `id` in the list, and back; nothing if it is not such a text.
std::string cursor_after(std::string_view id);
std::optional<std::string> id_of_cursor(std::string_view cursor);

}  // namespace sheer::http
