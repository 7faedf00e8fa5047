#include "server/http/negotiation.h"

#include <zlib.h>

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/url/grammar/ci_string.hpp>
#include <charconv>
#include <stdexcept>

#include "server/http/text.h"

namespace sheer::http {

namespace {

// Less does not become a packet fewer.
constexpr std::size_t least_compressed_bytes = 1024;
constexpr int gzip_window = 15 + 16;
constexpr std::string_view coding_mark = "-gzip\"";

/// An element of a list with its weight.
struct Weighted {
    std::string_view value;
    double weight = 1;
};

std::vector<Weighted> weighted_list(std::string_view field) {
    std::vector<Weighted> all;
    for (const std::string_view element : split(field, ',')) {
        const auto parts = split(element, ';');
        if (parts.front().empty()) continue;
        Weighted weighted{parts.front()};
        for (const std::string_view parameter : parts)
            if (parameter.starts_with("q=") || parameter.starts_with("Q="))
                std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), weighted.weight);
        all.push_back(weighted);
    }
    return all;
}

struct TypeParts {
    std::string_view type, subtype;
};

TypeParts parts_of(std::string_view media_type) {
    const std::size_t slash = media_type.find('/');
    if (slash == std::string_view::npos) return {media_type, ""};
    return {media_type.substr(0, slash), media_type.substr(slash + 1)};
}

bool fits(std::string_view one, std::string_view other) {
    return one == "*" || other == "*" || boost::beast::iequals(one, other);
}

/// How precisely a range names a type.
int precision(const TypeParts& range) {
    return (range.type != "*") + (range.subtype != "*");
}

bool is_compressible(std::string_view content_type) {
    const std::string type = media_type_of(content_type);
    return is_json_type(type) || (type.starts_with("text/") && type != "text/event-stream") ||
           type == "application/xml" || type == "image/svg+xml";
}

std::string with_mark(std::string etag) {
    if (etag.ends_with('"')) etag.replace(etag.size() - 1, 1, coding_mark);
    return etag;
}

/// Null if the body is sent as it is.
std::string* text_to_compress(Response& response) {
    auto* text = std::get_if<std::string>(&response.body);
    return text == nullptr || text->empty() || !response.headers.contains("Content-Encoding") ? nullptr : text;
}

}  // namespace

bool accepts(const std::optional<std::string>& accept, std::string_view media_type) {
    if (!accept || accept->empty()) return true;
    const TypeParts wanted = parts_of(media_type);
    int best = -1;
    bool is_allowed = false;
    for (const Weighted& element : weighted_list(*accept)) {
        const TypeParts range = parts_of(element.value);
        if (!fits(range.type, wanted.type) || !fits(range.subtype, wanted.subtype)) continue;
        if (precision(range) < best) continue;
        is_allowed = element.weight > 0 || (precision(range) == best && is_allowed);
        best = precision(range);
    }
    return is_allowed;
}

bool accepts_gzip(const std::optional<std::string>& accept_encoding) {
    if (!accept_encoding) return false;
    std::optional<bool> named, any;
    for (const Weighted& coding : weighted_list(*accept_encoding)) {
        if (boost::beast::iequals(coding.value, "gzip")) named = coding.weight > 0;
        if (coding.value == "*") any = coding.weight > 0;
    }
    return named.value_or(any.value_or(false));
}

std::string gzipped(std::string_view text) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib does not start");
    std::string packed(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int ended = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (ended != Z_STREAM_END) throw std::runtime_error("zlib did not compress a text");
    return packed;
}

void choose_coding(Response& response, const Request& request) {
    const auto* text = std::get_if<std::string>(&response.body);
    if (text == nullptr || text->size() <= least_compressed_bytes ||
        !is_compressible(response.headers.find("Content-Type").value_or("")))
        return;
    response.headers.add("Vary", "Accept-Encoding");
    if (!accepts_gzip(request.headers.joined("Accept-Encoding"))) return;
    response.headers.add("Content-Encoding", "gzip");
    if (const auto etag = response.headers.find("ETag")) response.headers.set("ETag", with_mark(*etag));
}

Response encoded(Response response, const std::string& target, BodyCache& known) {
    auto* text = text_to_compress(response);
    if (text == nullptr) return response;
    const auto etag = response.headers.find("ETag");
    *text = etag ? known.get(*etag + " " + target, [&] { return gzipped(*text); }) : gzipped(*text);
    return response;
}

std::optional<Response> encoded_if_known(Response response, const std::string& target, BodyCache& known) {
    auto* text = text_to_compress(response);
    if (text == nullptr) return response;
    const auto packed = known.find(response.headers.find("ETag").value_or("") + " " + target);
    if (packed == nullptr) return std::nullopt;
    *text = packed->body;
    return response;
}

Request without_coding(Request request) {
    for (const char* name : {"If-Match", "If-None-Match", "If-Range"}) {
        auto field = request.headers.joined(name);
        if (!field || field->find(coding_mark) == std::string::npos) continue;
        for (std::size_t at = 0; (at = field->find(coding_mark, at)) != std::string::npos;)
            field->replace(at, coding_mark.size(), "\"");
        request.headers.set(name, *field);
    }
    return request;
}

}  // namespace sheer::http
