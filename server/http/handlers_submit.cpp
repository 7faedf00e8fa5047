#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "renderer/params/param.h"
#include "renderer/spec/shaders.h"
#include "renderer/spec/spec.h"
#include "server/http/application.h"
#include "server/http/job_limits.h"
#include "server/http/paths.h"
#include "server/http/problem.h"
#include "server/http/queue_speed.h"
#include "server/http/quota.h"
#include "server/http/report_view.h"
#include "server/http/reuse.h"
#include "server/http/service.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

constexpr std::size_t max_key_bytes = 255;

std::string seconds_text(std::chrono::seconds seconds) {
    return fmt::format("{}", seconds.count());
}

std::optional<IdempotencyKey> idempotency_key(const Request& request, const nlohmann::json& document) {
    const auto key = request.headers.find("Idempotency-Key");
    if (!key) return std::nullopt;
    if (key->empty() || key->size() > max_key_bytes)
        throw Problem(400, fmt::format("Idempotency-Key must have 1 to {} bytes.", max_key_bytes));
    return IdempotencyKey{*key, sha256_hex(document.dump())};
}

/// Over HTTP a file is always an uploaded one, never a path.
AssetRule asset_rule(Service& service) {
    return [&service](const AssetReference& reference) -> std::string {
        if (!is_sha256(reference.name))
            return fmt::format("must be a built-in name or the SHA-256 of an uploaded {}, in 64 lower-case hex digits",
                               reference.type);
        const auto asset = service.store.assets().find(reference.name);
        if (!asset) return fmt::format("there is no asset with this SHA-256; upload it with POST {}", assets_path);
        if (!asset->broken.empty())
            return fmt::format("this asset is damaged, {}; upload it again with POST {}", asset->broken, assets_path);
        if (asset->type != reference.type)
            return fmt::format("this asset is a {} ({}), not a {}", asset->type, asset->media_type, reference.type);
        return "";
    };
}

/// A sweep may have a thousand shaders; those beyond this are compiled when they are rendered.
constexpr std::size_t max_compiled_shaders = 16;

/// Throws SpecError with every wrong field, if it asks for too much, and if the user's own shading does not compile.
Spec checked_spec(Service& service, const nlohmann::json& document) {
    Spec spec = parse_spec(document, asset_rule(service));
    require_within(service.limits.job, spec);
    if (!spec.against.empty() && !spec.against.starts_with("baseline:")) {
        const auto before = service.store.reports().find(spec.against);
        if (!before || before->status != Status::done)
            throw SpecError(std::vector<FieldError>{{"/against", "there is no done report with this id"}});
    }
    std::vector<SpecShader> shaders = shaders_of(spec);
    if (!shaders.empty()) require_sandbox(service, "Your own GLSL");
    if (!service.check_shading) return spec;
    if (shaders.size() > max_compiled_shaders) shaders.resize(max_compiled_shaders);
    std::vector<FieldError> errors;
    for (const SpecShader& shader : shaders)
        if (const std::string wrong = service.check_shading(shader.glsl); !wrong.empty())
            errors.push_back({shader.pointer, wrong});
    if (!errors.empty()) throw SpecError(std::move(errors));
    return spec;
}

struct Submitted {
    ReportRecord record;
    bool is_reused = false;  ///< it was done before
};

Submitted submit(Service& service, QueueSpeed& speed, const Request& request) {
    const nlohmann::json document = json_body(request);
    const Spec spec = checked_spec(service, document);
    NewReport report{.id = service.ids.next(), .spec = spec.canonical_text()};
    report.spec_sha256 = sha256_hex(report.spec);
    // Of several devices nobody knows whether their drivers are still the same.
    if (document.value("reuse", false) && spec.against.empty() && spec.devices.empty())
        if (auto known = reusable_report(service, report.spec_sha256)) return {std::move(*known), true};
    report.idempotency = idempotency_key(request, document);
    const auto token = service.access.token_of(request);
    if (token) report.sender = Sender{token->name, token->quota.jobs, token->quota.seconds};
    report.cost_mpx = cost_mpx(spec);
    const AnswerLimits& limits = service.limits;
    const SubmitResult result = service.store.queue().submit(
        report, {.jobs = limits.max_queued, .cost_mpx = static_cast<double>(limits.max_queued_cost)});
    if (result.outcome == SubmitResult::Outcome::queue_full)
        throw Problem(429, fmt::format("The queue is full: it takes {} comparisons and {} megapixels (width x height x "
                                       "rounds x methods x points).",
                                       limits.max_queued, limits.max_queued_cost))
            .with("Retry-After", seconds_text(speed.until_a_place()));
    if (result.outcome == SubmitResult::Outcome::too_many_jobs) throw too_many_jobs(*token, speed.until_a_place());
    if (result.outcome == SubmitResult::Outcome::seconds_used_up) throw seconds_used_up(service, *token);
    if (result.outcome == SubmitResult::Outcome::key_reused)
        throw Problem(422, "This Idempotency-Key was used with another spec.");
    const auto record = service.store.reports().find(result.id);
    if (!record) throw Problem(409, "The report was deleted in the meantime.");
    return {*record};
}

Response accepted(Service& service, QueueSpeed& speed, const ReportRecord& record) {
    Response response = report_response(202, record, queue_notes(service, record));
    response.headers.add("Location", fmt::format("{}/{}", reports_path, record.id));
    response.headers.add("Retry-After", seconds_text(speed.until_empty()));
    return response;
}

std::optional<Response> if_final(Service& service, const std::string& id) {
    const auto record = service.store.reports().find(id);
    if (!record) throw Problem(404, "The report was deleted in the meantime.");
    if (!is_final(record->status)) return std::nullopt;
    Response response = report_response(200, *record);
    response.headers.add("Location", fmt::format("{}/{}", reports_path, id));
    return response;
}

Answer post_report(Service& service, const std::shared_ptr<QueueSpeed>& speed, const Request& request) {
    const auto [record, is_reused] = submit(service, *speed, request);
    if (is_reused) {
        Response response = report_response(200, record);
        response.headers.add("Location", fmt::format("{}/{}", reports_path, record.id));
        response.headers.add("Sheer-Reused", utc_text(record.finished_ms.value_or(0)));
        return response;
    }
    const auto wait_s = preferred_wait_s(request.headers.find("Prefer").value_or(""));
    if (!wait_s) return accepted(service, *speed, record);
    const auto limit = std::min(std::chrono::seconds(*wait_s), service.limits.max_wait);
    const auto applied = [limit](Response response) {
        response.headers.add("Preference-Applied", fmt::format("wait={}", limit.count()));
        return response;
    };
    Waiting waiting{.limit = limit};
    waiting.ready = [&service, id = record.id, applied]() -> std::optional<Response> {
        auto response = if_final(service, id);
        if (response) response = applied(std::move(*response));
        return response;
    };
    waiting.otherwise = [&service, speed, record, applied] {
        return applied(accepted(service, *speed, service.store.reports().find(record.id).value_or(record)));
    };
    return waiting;
}

Answer validate_spec(Service& service, const Request& request) {
    const Spec spec = checked_spec(service, json_body(request));
    return text_response(200, spec.canonical_text(), "application/json");
}

}  // namespace

std::vector<Route> submit_routes(Service& service) {
    const Reply bad_spec{422, "The spec is wrong; `errors` names every wrong field", "application/problem+json",
                         "Problem"};
    auto speed = std::make_shared<QueueSpeed>(service.store.reports(), [&service] { return service.clock(); });
    return {
        {.method = "POST",
         .pattern = reports_path,
         .id = "createReport",
         .summary = "Queue a comparison",
         .description =
             "The report is rendered by a worker; follow its events, ask for it after Retry-After seconds, or wait "
             "for it in this call with `Prefer: wait=60`. Repeat a call that got no answer with the same "
             "Idempotency-Key.",
         .headers = {{"Prefer", "wait=N: answer with the finished report if it is ready within N seconds"},
                     {"Idempotency-Key", "the same key with the same spec returns the same report"}},
         .body_schema = "Spec",
         .replies =
             {{202,
               "Queued; Location is the address of the report",
               "application/json",
               "AnyReport",
               {"Location", "Retry-After", "ETag"},
               "QueuedReport"},
              {200,
               "Finished within the time that Prefer gave, or reused: then Sheer-Reused says since when it is done",
               "application/json",
               "AnyReport",
               {"Location", "ETag", "Preference-Applied", "Sheer-Reused"}},
              bad_spec,
              {429,
               "The queue is full, or the token's quota is used up; Retry-After says when to try again",
               "application/problem+json",
               "Problem",
               {"Retry-After"}},
              {507, "There is no room for reports", "application/problem+json", "Problem"}},
         .handle = [&service, speed](const Request& request) { return post_report(service, speed, request); },
         .lane = Lane::specs},
        {.method = "POST",
         .pattern = "/api/v1/specs/validate",
         .id = "validateSpec",
         .summary = "Check a spec and fill in its defaults",
         .description = "Every wrong field is named at once, and the user's own GLSL is compiled; nothing is queued.",
         .body_schema = "Spec",
         .replies = {{200, "The normalised spec", "application/json", "NormalisedSpec"}, bad_spec},
         .handle = [&service](const Request& request) { return validate_spec(service, request); },
         .lane = Lane::specs},
    };
}

}  // namespace sheer::http
