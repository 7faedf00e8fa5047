#include "server/http/message.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>

#include "renderer/params/json_text.h"

namespace sheer::http {

std::optional<std::string> Headers::find(std::string_view name) const {
    for (const auto& [field, value] : m_fields)
        if (boost::beast::iequals(field, name)) return value;
    return std::nullopt;
}

std::optional<std::string> Headers::joined(std::string_view name) const {
    std::optional<std::string> all;
    for (const auto& [field, value] : m_fields)
        if (boost::beast::iequals(field, name)) all = all ? *all + ", " + value : value;
    return all;
}

std::size_t Headers::count(std::string_view name) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(m_fields, [&](const auto& field) { return boost::beast::iequals(field.first, name); }));
}

void Headers::set(std::string_view name, std::string value) {
    std::erase_if(m_fields, [&](const auto& field) { return boost::beast::iequals(field.first, name); });
    m_fields.emplace_back(name, std::move(value));
}

Response text_response(int status, std::string body, std::string media_type) {
    Response response{.status = status, .headers = {}, .body = std::move(body)};
    response.headers.add("Content-Type", std::move(media_type));
    return response;
}

Response json_response(int status, const nlohmann::json& body) {
    return text_response(status, json_line(body), "application/json");
}

}  // namespace sheer::http
