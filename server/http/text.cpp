#include "server/http/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/url/grammar/ci_string.hpp>
#include <boost/url/grammar/lut_chars.hpp>
#include <boost/url/parse_path.hpp>
#include <boost/url/parse_query.hpp>
#include <boost/url/rfc/pchars.hpp>
#include <boost/url/rfc/unreserved_chars.hpp>
#include <charconv>

#include "server/jobs/report_id.h"

namespace sheer::http {

namespace beast = boost::beast;
namespace urls = boost::urls;

namespace {

constexpr std::string_view cursor_prefix = "after:";

std::optional<int> hex_value(char digit) {
    int value = 0;
    const auto [end, error] = std::from_chars(&digit, &digit + 1, value, 16);
    if (error != std::errc() || end != &digit + 1) return std::nullopt;
    return value;
}

template <typename IsKept>
std::string escaped(std::string_view text, const IsKept& is_kept) {
    std::string all;
    for (const char c : text) {
        if (is_kept(c)) {
            all += c;
        } else {
            all += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return all;
}

/// Whether a path has neither escapes nor characters that need one, nor an empty segment within, nor a dot in front.
bool is_plain_path(std::string_view path) {
    constexpr auto plain = urls::unreserved_chars + urls::grammar::lut_chars('/');
    return path.starts_with('/') && !path.starts_with("/.") && path.find("//") == path.npos &&
           std::ranges::all_of(path, plain);
}

std::vector<std::string> plain_segments(std::string_view path) {
    std::vector<std::string> segments;
    if (path.size() == 1) return segments;
    segments.reserve(8);
    while (!path.empty()) {
        path.remove_prefix(1);
        const std::size_t end = std::min(path.find('/'), path.size());
        segments.emplace_back(path.substr(0, end));
        path.remove_prefix(end);
    }
    return segments;
}

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), urls::grammar::to_lower);
    return lower;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.push_back(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

std::string with_ascii_only(std::string_view text) {
    return escaped(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::string with_escapes(std::string_view text) {
    constexpr auto kept = urls::pchars + urls::grammar::lut_chars("/?%");
    return escaped(text, kept);
}

std::optional<std::vector<std::string>> path_segments(std::string_view path) {
    if (is_plain_path(path)) return plain_segments(path);
    const std::string legal = with_escapes(path);
    const auto parsed = urls::parse_path(legal);
    if (!parsed || !parsed->is_absolute()) return std::nullopt;
    std::vector<std::string> segments;
    for (const auto segment : *parsed) segments.push_back(segment.decode());
    return segments;
}

std::optional<std::vector<std::pair<std::string, std::string>>> query_pairs(std::string_view query) {
    const std::string legal = with_escapes(query);
    const auto parsed = urls::parse_query(legal);
    if (!parsed) return std::nullopt;
    const urls::encoding_opts plus_is_space(true);
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& pair : *parsed)
        if (!pair.key.empty() || pair.has_value)
            pairs.emplace_back(pair.key.decode(plus_is_space), pair.value.decode(plus_is_space));
    return pairs;
}

std::optional<int> preferred_wait_s(std::string_view prefer) {
    for (const std::string_view preference : split(prefer, ',')) {
        // A preference with its parameters is a list of parameters, except that it does not begin with a semicolon.
        const std::string parameters = fmt::format(";{}", preference);
        const beast::http::param_list list(parameters);
        const auto first = list.begin();
        if (first == list.end() || !beast::iequals(first->first, "wait")) continue;
        const std::string_view digits = first->second;
        int seconds = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
        if (error == std::errc() && end == digits.data() + digits.size() && seconds >= 0) return seconds;
    }
    return std::nullopt;
}

bool names_etag(std::string_view if_none_match, std::string_view etag) {
    return std::ranges::any_of(split(if_none_match, ','), [&](std::string_view candidate) {
        if (candidate.starts_with("W/")) candidate.remove_prefix(2);
        return candidate == "*" || (!etag.empty() && candidate == etag);
    });
}

std::string media_type_of(std::string_view content_type) {
    return in_lower_case(split(content_type, ';').front());
}

bool is_json_type(std::string_view content_type) {
    const std::string type = media_type_of(content_type);
    return type == "application/json" || (type.starts_with("application/") && type.ends_with("+json"));
}

std::string host_name(std::string_view host) {
    const std::size_t end = std::min(host.starts_with('[') ? host.find(']') + 1 : host.find(':'), host.size());
    const std::string_view rest = host.substr(end);
    const bool is_port = rest.starts_with(':') && rest.find_first_not_of("0123456789", 1) == rest.npos;
    return in_lower_case(rest.empty() || is_port ? host.substr(0, end) : host);
}

std::string event_text(std::int64_t id, std::string_view event, std::string_view data) {
    return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", id, event, data);
}

std::string cursor_after(std::string_view id) {
    std::string cursor;
    for (const char c : fmt::format("{}{}", cursor_prefix, id))
        cursor += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return cursor;
}

std::optional<std::string> id_of_cursor(std::string_view cursor) {
    std::string text;
    if (cursor.size() % 2 != 0) return std::nullopt;
    for (std::size_t i = 0; i < cursor.size(); i += 2) {
        const auto high = hex_value(cursor[i]), low = hex_value(cursor[i + 1]);
        if (!high || !low) return std::nullopt;
        text += static_cast<char>(*high * 16 + *low);
    }
    if (!text.starts_with(cursor_prefix)) return std::nullopt;
    std::string id = text.substr(cursor_prefix.size());
    if (!is_report_id(id)) return std::nullopt;
    return id;
}

}  // namespace sheer::http
