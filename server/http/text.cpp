#include "server/http/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "server/jobs/report_id.h"

namespace sheer::http {

namespace {

constexpr std::string_view cursor_prefix = "after:";

std::optional<int> hex_value(char digit) {
    int value = 0;
    const auto [end, error] = std::from_chars(&digit, &digit + 1, value, 16);
    if (error != std::errc() || end != &digit + 1) return std::nullopt;
    return value;
}

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

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

std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%') {
            if (i + 2 >= text.size()) return std::nullopt;
            const auto high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
            if (!high || !low) return std::nullopt;
            decoded += static_cast<char>(*high * 16 + *low);
            i += 2;
        } else {
            decoded += plus_is_space && text[i] == '+' ? ' ' : text[i];
        }
    }
    return decoded;
}

std::optional<std::vector<std::pair<std::string, std::string>>> query_pairs(std::string_view query) {
    std::vector<std::pair<std::string, std::string>> pairs;
    if (query.empty()) return pairs;
    for (const std::string_view part : split(query, '&')) {
        if (part.empty()) continue;
        const std::size_t equals = part.find('=');
        const auto name = percent_decoded(part.substr(0, equals), true);
        const auto value =
            percent_decoded(equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1), true);
        if (!name || !value) return std::nullopt;
        pairs.emplace_back(*name, *value);
    }
    return pairs;
}

std::optional<int> preferred_wait_s(std::string_view prefer) {
    for (const std::string_view preference : split(prefer, ',')) {
        const std::string_view pair = split(preference, ';').front();
        const std::size_t equals = pair.find('=');
        if (equals == std::string_view::npos || !equal_ignoring_case(trimmed(pair.substr(0, equals)), "wait")) continue;
        const std::string_view digits = trimmed(pair.substr(equals + 1));
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
    std::string type(split(content_type, ';').front());
    std::ranges::transform(type, type.begin(), lower);
    return type;
}

bool is_json_type(std::string_view content_type) {
    const std::string type = media_type_of(content_type);
    return type == "application/json" || (type.starts_with("application/") && type.ends_with("+json"));
}

std::string host_name(std::string_view host) {
    const std::size_t end = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
    std::string name(host.substr(0, end));
    std::ranges::transform(name, name.begin(), lower);
    return name;
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
