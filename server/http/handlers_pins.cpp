#include <fmt/format.h>

#include "renderer/core/clock.h"
#include "server/http/answers.h"
#include "server/http/application.h"
#include "server/http/problem.h"
#include "server/http/report_view.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr std::size_t longest_remark_bytes = 1000;

/// What PUT takes.
std::vector<Param> pin_fields() {
    return {Param::text("by", "who pins it", "", longest_remark_bytes),
            Param::text("reason", "why", "", longest_remark_bytes)};
}

Response pin_response(Service& service, int status, const std::string& id) {
    const auto pin = service.store.pins().find(id);
    if (!pin) throw Problem(404, "The report is not pinned, or does not exist.");
    return json_response(status, to_document(answer::Pin{.report = id,
                                                         .url = fmt::format("{}/{}", reports_path, id),
                                                         .pinned_at = utc_text(pin->pinned_ms),
                                                         .by = pin->by,
                                                         .reason = pin->reason}));
}

Answer put_pin(Service& service, const Request& request) {
    const std::string id = request.path_values.at("id");
    std::vector<FieldError> errors;
    const json body = read_fields(json_body(request), "", pin_fields(), errors);
    if (!errors.empty()) throw Problem(422, "The pin is wrong.", errors);
    using enum Pins::Pinning;
    const auto pinning = service.store.pins().pin({id, 0, body["by"], body["reason"]});
    if (pinning == not_found) throw Problem(404, "There is no such report.");
    if (pinning == not_final) throw Problem(409, "Only a report that has ended can be pinned.");
    return pin_response(service, pinning == added ? 201 : 200, id);
}

Answer delete_pin(Service& service, const Request& request) {
    if (!service.store.pins().unpin(request.path_values.at("id")))
        throw Problem(404, "The report is not pinned, or does not exist.");
    return Response{.status = 204, .headers = {}, .body = {}};
}

Route pin_route(std::string method, std::string id, std::string summary, std::vector<Reply> replies, Handler handle) {
    replies.push_back({404, "The report is not pinned, or does not exist", "application/problem+json", "Problem"});
    return {.method = std::move(method),
            .pattern = std::string(reports_path) + "/{id}/pin",
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle)};
}

}  // namespace

json pin_schema() {
    return schema_of(pin_fields());
}

std::vector<Route> pin_routes(Service& service) {
    Route put =
        pin_route("PUT", "pinReport", "Pin a report that has ended: it is neither deleted nor pruned",
                  {{201, "It is pinned", "application/json", "Pin"},
                   {200, "It was pinned before, and has a new time, `by` and `reason`", "application/json", "Pin"},
                   {409, "The report has not ended", "application/problem+json", "Problem"},
                   {422, "The body is wrong", "application/problem+json", "Problem"}},
                  [&service](const Request& request) { return put_pin(service, request); });
    put.body_schema = "PinRemark";
    Route unpin = pin_route("DELETE", "unpinReport", "Unpin a report", {{204, "It is no longer pinned", "", ""}},
                            [&service](const Request& request) { return delete_pin(service, request); });
    put.scope = unpin.scope = Scope::admin;
    return {
        pin_route(
            "GET", "getPin", "Who pinned a report, when and why", {{200, "It is pinned", "application/json", "Pin"}},
            [&service](const Request& request) { return pin_response(service, 200, request.path_values.at("id")); }),
        std::move(put), std::move(unpin)};
}

}  // namespace sheer::http
