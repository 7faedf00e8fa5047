#include "server/http/problem.h"

#include <algorithm>
#include <map>

#include "renderer/params/json_text.h"
#include "server/http/answers.h"

namespace sheer::http {

using nlohmann::json;

const char* status_phrase(int status) {
    static const std::map<int, const char*> phrases{{100, "Continue"},
                                                    {200, "OK"},
                                                    {201, "Created"},
                                                    {202, "Accepted"},
                                                    {204, "No Content"},
                                                    {304, "Not Modified"},
                                                    {308, "Permanent Redirect"},
                                                    {400, "Bad Request"},
                                                    {403, "Forbidden"},
                                                    {404, "Not Found"},
                                                    {405, "Method Not Allowed"},
                                                    {406, "Not Acceptable"},
                                                    {409, "Conflict"},
                                                    {410, "Gone"},
                                                    {412, "Precondition Failed"},
                                                    {413, "Content Too Large"},
                                                    {415, "Unsupported Media Type"},
                                                    {421, "Misdirected Request"},
                                                    {422, "Unprocessable Content"},
                                                    {429, "Too Many Requests"},
                                                    {431, "Request Header Fields Too Large"},
                                                    {500, "Internal Server Error"},
                                                    {501, "Not Implemented"},
                                                    {503, "Service Unavailable"},
                                                    {505, "HTTP Version Not Supported"},
                                                    {507, "Insufficient Storage"}};
    const auto found = phrases.find(status);
    return found == phrases.end() ? "Unknown" : found->second;
}

Response problem(int status, const std::string& detail, const std::vector<FieldError>& errors, std::size_t error_count,
                 const std::vector<std::string>& allow) {
    answer::Problem body{.title = status_phrase(status), .status = status, .detail = detail, .allow = allow};
    for (const FieldError& error : errors) {
        if (body.errors.size() == max_told_errors) break;
        body.errors.push_back({error.pointer, error.detail});
    }
    if (!errors.empty()) body.error_count = std::max(error_count, errors.size());
    return text_response(status, json_line(to_document(body)), "application/problem+json");
}

Response Problem::response() const {
    Response response = problem(m_status, what(), m_errors, 0, m_allow);
    for (const auto& [name, value] : m_headers) response.headers.add(name, value);
    return response;
}

}  // namespace sheer::http
