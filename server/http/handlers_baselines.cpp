#include <fmt/format.h>

#include "renderer/core/clock.h"
#include "renderer/spec/against_name.h"
#include "server/http/answers.h"
#include "server/http/application.h"
#include "server/http/paths.h"
#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr std::size_t max_report_id_bytes = 200, max_remark_bytes = 1000;

/// What PUT takes.
std::vector<Param> acceptance_fields() {
    return {Param::text("report", "id of the done report", "", max_report_id_bytes).required(),
            Param::text("by", "who accepts it", "", max_remark_bytes),
            Param::text("reason", "why", "", max_remark_bytes)};
}

std::string name_of(const Request& request) {
    const std::string name = request.path_values.at("name");
    if (const std::string wrong = wrong_baseline_name(name); !wrong.empty())
        throw Problem(422, fmt::format("The name {}.", wrong));
    return name;
}

answer::AcceptedReport told(Service& service, const AcceptedReport& accepted) {
    answer::AcceptedReport told{.report = accepted.report_id,
                                .url = fmt::format("{}/{}", reports_path, accepted.report_id),
                                .accepted_at = utc_text(accepted.accepted_ms),
                                .by = accepted.by,
                                .reason = accepted.reason};
    const auto record = service.store.reports().find(accepted.report_id);
    if (!record) return told;
    const json report = json::parse(record->report, nullptr, false);
    if (!report.is_object()) return told;
    const json device = report.value("device", json());
    if (device.is_object())
        told.device = fmt::format("{} on {}", device.value("renderer", ""), device.value("cpu", ""));
    told.spec_sha256 = record->spec_sha256;
    told.title = report.value(json::json_pointer("/spec/title"), "");
    return told;
}

/// Those of one baseline, or all.
std::vector<answer::Baseline> baselines(Service& service, const std::string& name) {
    std::vector<answer::Baseline> all;
    for (const AcceptedReport& accepted : service.store.baselines().list(name)) {
        if (all.empty() || all.back().name != accepted.name)
            all.push_back({.name = accepted.name, .url = fmt::format("{}/{}", baselines_path, accepted.name)});
        all.back().reports.push_back(told(service, accepted));
    }
    return all;
}

Answer get_baseline(Service& service, const Request& request) {
    const auto found = baselines(service, name_of(request));
    if (found.empty()) throw Problem(404, "There is no such baseline.");
    return json_response(200, to_document(found.front()));
}

Answer put_baseline(Service& service, const Request& request) {
    const std::string name = name_of(request);
    std::vector<FieldError> errors;
    const json body = read_fields(json_body(request), "", acceptance_fields(), errors);
    if (!errors.empty()) throw Problem(422, "The acceptance is wrong.", errors);
    using enum Baselines::Acceptance;
    const auto acceptance = service.store.baselines().accept({name, body["report"], 0, body["by"], body["reason"]});
    if (acceptance == not_found)
        throw Problem(422, "The report cannot be accepted.", {{"/report", "there is no such report"}});
    if (acceptance == not_done) throw Problem(409, "Only a report that is done can be accepted.");
    return json_response(acceptance == added ? 201 : 200, to_document(baselines(service, name).front()));
}

Answer delete_baseline(Service& service, const Request& request) {
    if (service.store.baselines().forget(name_of(request), request.query["report"]) == 0)
        throw Problem(404, "There is no such baseline, or it has no such report.");
    return Response{.status = 204, .headers = {}, .body = {}};
}

Route baseline_route(std::string method, std::string id, std::string summary, std::vector<Reply> replies,
                     Handler handle) {
    replies.push_back({422, "The name or the body is wrong", "application/problem+json", "Problem"});
    return {.method = std::move(method),
            .pattern = std::string(baselines_path) + "/{name}",
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle)};
}

}  // namespace

json acceptance_schema() {
    return schema_of(acceptance_fields());
}

std::vector<Route> baseline_routes(Service& service) {
    const Reply unknown{404, "There is no such baseline", "application/problem+json", "Problem"};
    Route put = baseline_route(
        "PUT", "acceptReport", "Accept a done report as one that others are compared with",
        {{201, "It is accepted; the baseline as it is now", "application/json", "Baseline"},
         {200, "It was accepted before, and has a new time, `by` and `reason`", "application/json", "Baseline"},
         {409, "The report is not done", "application/problem+json", "Problem"}},
        [&service](const Request& request) { return put_baseline(service, request); });
    put.body_schema = "Acceptance";
    put.description =
        "Reports are never accepted by themselves. Several can be accepted under one name; of those from the same "
        "device, the one accepted last is compared with.";
    Route forget = baseline_route("DELETE", "forgetBaseline",
                                  "Forget a baseline, or one report of it; the reports themselves stay",
                                  {{204, "It is forgotten", "", ""}, unknown},
                                  [&service](const Request& request) { return delete_baseline(service, request); });
    put.scope = forget.scope = Scope::admin;
    forget.query = {Param::text("report", "id of the only report to forget", "", max_report_id_bytes)};
    return {{.method = "GET",
             .pattern = baselines_path,
             .id = "listBaselines",
             .summary = "Every baseline with its accepted reports",
             .replies = {{200, "By name; the reports accepted last first", "application/json", "BaselineList"}},
             .handle =
                 [&service](const Request&) {
                     return json_response(200, to_document(answer::BaselineList{baselines(service, "")}));
                 }},
            baseline_route("GET", "getBaseline", "A baseline: its accepted reports, those accepted last first",
                           {{200, "The baseline", "application/json", "Baseline"}, unknown},
                           [&service](const Request& request) { return get_baseline(service, request); }),
            std::move(put),
            std::move(forget)};
}

}  // namespace sheer::http
