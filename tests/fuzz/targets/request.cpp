#include <sstream>

#include "server/http/application.h"
#include "server/http/request_head.h"
#include "server/http/service.h"
#include "tests/fuzz/target.h"
#include "tests/unit/memory_store.h"

namespace sheer::test {

namespace {

using namespace http;

/// A service without sockets and children.
struct World {
    MemoryStore store{make_memory_state(), {}, [] { return std::int64_t{1}; }};
    ReportIds ids{[] { return std::int64_t{1}; }};
    Service service{.store = store,
                    .ids = ids,
                    .clock = [] { return std::int64_t{1}; },
                    .list_devices = [] { return nlohmann::json::array(); },
                    .check_upload = [](const std::string&, const std::string&) { return UploadVerdict{}; },
                    .pixel = [](const std::string&, const PixelPlace&) { return PixelAnswer{}; },
                    .diff = [](const DiffQuestion&) { return DiffAnswer{}; },
                    .limits = {.max_queued = 2}};
    Application application{make_guard(true, {}), make_router(service)};
};

/// "GET /target", a line for each field, an empty line, the body. What no parser of HTTP lets through is left out.
Request request_of(std::string_view input) {
    std::istringstream lines{std::string(input)};
    const auto next = [&lines] {
        std::string line;
        std::getline(lines, line);
        std::erase_if(line, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
        return line;
    };
    const std::string first = next();
    const std::size_t space = std::min(first.find(' '), first.size());
    Request request{.method = first.substr(0, space), .target = first.substr(std::min(space + 1, first.size()))};
    for (std::string line = next(); !line.empty(); line = next())
        if (const std::size_t colon = line.find(": "); colon != std::string::npos)
            request.headers.add(line.substr(0, colon), line.substr(colon + 2));
    request.body.assign(std::istreambuf_iterator<char>(lines), {});
    return request;
}

/// Every request gets an answer, and none of them 500: that is for errors nobody thought of.
void ask(std::string_view input) {
    static World world;
    Request request = request_of(input);
    if (check_head(request, 11)) return;
    world.application.handling(request.method, request.target);
    const Answer answer = world.application.answer(std::move(request));
    const auto judge = [](const Response& response) {
        require(response.status >= 200 && response.status < 600 && response.status != 500, "a status of an error");
    };
    if (const auto* response = std::get_if<Response>(&answer)) judge(*response);
    if (const auto* waiting = std::get_if<Waiting>(&answer)) judge(waiting->otherwise());
    if (const auto* stream = std::get_if<EventStream>(&answer)) judge(stream->head);
}

}  // namespace

FuzzTarget fuzz_request() {
    return {"request", ask};
}

}  // namespace sheer::test
