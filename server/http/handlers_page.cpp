#include <fmt/format.h>

#include <map>

#include "embedded_web.h"
#include "server/http/service.h"

namespace sheer::http {

namespace {

constexpr const char* policy =
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; script-src 'self'; connect-src 'self'; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

std::string media_type_of_path(std::string_view path) {
    static const std::map<std::string_view, const char*> types{{"html", "text/html; charset=utf-8"},
                                                               {"js", "text/javascript; charset=utf-8"},
                                                               {"mjs", "text/javascript; charset=utf-8"},
                                                               {"css", "text/css; charset=utf-8"},
                                                               {"json", "application/json"},
                                                               {"svg", "image/svg+xml"},
                                                               {"png", "image/png"},
                                                               {"jpg", "image/jpeg"},
                                                               {"ico", "image/x-icon"},
                                                               {"woff2", "font/woff2"},
                                                               {"txt", "text/plain; charset=utf-8"}};
    const auto found = types.find(path.substr(path.rfind('.') + 1));
    return found == types.end() ? "application/octet-stream" : found->second;
}

Route file_route(std::string pattern, const EmbeddedFile& file) {
    Response response = text_response(200, std::string(file.bytes), media_type_of_path(file.path));
    response.headers.add("Content-Security-Policy", policy);
    response.headers.add("Cross-Origin-Opener-Policy", "same-origin");
    return {.method = "GET",
            .pattern = std::move(pattern),
            .id = "",
            .summary = "",
            .replies = {},
            .handle = always(std::move(response)),
            .scope = Scope::none};
}

}  // namespace

std::vector<Route> page_routes() {
    std::vector<Route> routes;
    for (const EmbeddedFile& file : embedded_web()) {
        routes.push_back(file_route(fmt::format("/{}", file.path), file));
        if (file.path == "index.html") routes.push_back(file_route("/", file));
    }
    return routes;
}

}  // namespace sheer::http
