#include "server/cli/service_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <type_traits>

#include "renderer/command/command.h"
#include "server/cli/retention_config.h"
#include "server/http/guard.h"
#include "server/http/path_prefix.h"
#include "server/postgres/address.h"
#include "server/process/fork_server.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

constexpr double kibibyte = 1024, mebibyte = 1024 * kibibyte, gibibyte = 1024 * mebibyte, tebibyte = 1024 * gibibyte;
constexpr double day_s = 86'400, week_s = 7 * day_s, hour_s = 3600;
constexpr double shortest_s = 0.05;

/// A field of the file, and the member that gets its value. Its default is the member's value in a new ServiceConfig.
struct Setting {
    Param param;
    std::function<void(ServiceConfig& config, const json& value)> set;
};

/// The fields under one name; "" for those at the top level.
struct Section {
    std::string name, summary;
    std::vector<Setting> settings;
};

/// The place of a value in a ServiceConfig.
template <typename Outer, typename Value>
auto in(Outer ServiceConfig::*outer, Value Outer::*value) {
    return [=](ServiceConfig& config) -> Value& { return config.*outer.*value; };
}
template <typename Value>
auto at(Value ServiceConfig::*value) {
    return [=](ServiceConfig& config) -> Value& { return config.*value; };
}

template <typename Place>
Setting integer(std::string name, std::string summary, std::string unit, double min, double max, Place place) {
    using Number = std::remove_reference_t<std::invoke_result_t<Place, ServiceConfig&>>;
    ServiceConfig defaults;
    const auto fallback = static_cast<long long>(place(defaults));
    return {Param::integer(std::move(name), std::move(summary), std::move(unit), fallback, min, max),
            [place](ServiceConfig& config, const json& value) { place(config) = value.get<Number>(); }};
}

template <typename Place>
Setting bytes(std::string name, std::string summary, double min, double max, Place place) {
    return integer(std::move(name), std::move(summary), "byte", min, max, place);
}

/// For std::chrono::milliseconds, or a count of them.
template <typename Place>
Setting seconds(std::string name, std::string summary, double max_s, Place place) {
    using Time = std::remove_reference_t<std::invoke_result_t<Place, ServiceConfig&>>;
    ServiceConfig defaults;
    const std::chrono::duration<double> fallback = std::chrono::milliseconds(place(defaults));
    return {Param::number(std::move(name), std::move(summary), "s", fallback.count(), shortest_s, max_s),
            [place](ServiceConfig& config, const json& value) {
                place(config) = Time(static_cast<std::int64_t>(value.get<double>() * 1000));
            }};
}

/// For std::chrono::seconds.
template <typename Place>
Setting whole_seconds(std::string name, std::string summary, double min_s, double max_s, Place place) {
    ServiceConfig defaults;
    return {Param::integer(std::move(name), std::move(summary), "s", place(defaults).count(), min_s, max_s),
            [place](ServiceConfig& config, const json& value) {
                place(config) = std::chrono::seconds(value.get<std::int64_t>());
            }};
}

Section general_settings() {
    const ServiceConfig defaults;
    Param hosts{.name = "allowed_hosts",
                .kind = Param::Kind::any,
                .summary = "further host names for which the service answers"};
    hosts.default_value = json::array();
    Param origins{.name = "cors_origins",
                  .kind = Param::Kind::any,
                  .summary = "origins of other sites, such as https://ci.example, whose pages may use the service"};
    origins.default_value = json::array();
    return {
        "",
        "",
        {{Param::text("listen", "ADDRESS:PORT; port 0 takes any free port, which is printed on standard output",
                      defaults.listen, 200),
          [](ServiceConfig& config, const json& value) { config.listen = value; }},
         {Param::text("data", "folder of the archive: `archive.sqlite`, `blobs/`, `assets/`, `scratch/`, `shaders/`",
                      defaults.data.string(), 4096),
          [](ServiceConfig& config, const json& value) { config.data = value.get<std::string>(); }},
         {Param::text("store",
                      "URL of a PostgreSQL database that services and workers on many machines share, such as "
                      "`postgresql://sheer@db.example/sheer`, instead of the archive in `data`, where then only copies "
                      "and scratch files are; the environment variable SHEER_STORE goes before it",
                      defaults.store, 4096),
          [](ServiceConfig& config, const json& value) { config.store = value; }},
         integer("workers",
                 "worker processes; they disturb each other's timings, so use more than one only for pictures, not "
                 "for measurements; 0 for none",
                 "", 0, 256, at(&ServiceConfig::workers)),
         {hosts,
          [](ServiceConfig& config, const json& value) { config.allowed_hosts = value.get<std::set<std::string>>(); }},
         {origins,
          [](ServiceConfig& config, const json& value) { config.cors_origins = value.get<std::set<std::string>>(); }},
         {Param::text("path_prefix",
                      "path under which a proxy offers the service, such as `/sheer`: page, links, Location and "
                      "events are all below it",
                      defaults.path_prefix, 200),
          [](ServiceConfig& config, const json& value) { config.path_prefix = value; }},
         {Param::text("tokens", "file of the tokens that `sheer token create` makes; \"\" for `tokens.json` in `data`",
                      defaults.tokens.string(), 4096),
          [](ServiceConfig& config, const json& value) { config.tokens = value.get<std::string>(); }},
         {Param::boolean("behind_proxy",
                         "whether a proxy decides who may use the service; otherwise it listens beyond loopback only "
                         "with tokens",
                         defaults.behind_proxy),
          [](ServiceConfig& config, const json& value) { config.behind_proxy = value; }},
         {Param::choice("access_log",
                        "a line for each request: as text among the other messages of the level info, or as a line of "
                        "JSON; reloaded on SIGHUP",
                        "text", {"off", "text", "json"}),
          [](ServiceConfig& config, const json& value) {
              using enum http::AccessLog;
              config.access_log = value == "off" ? off : value == "json" ? http::AccessLog::json_lines : text;
          }},
         {Param::choice("log_level", "least severe messages that are logged; reloaded on SIGHUP", defaults.log_level,
                        {"debug", "info", "warning", "error"}),
          [](ServiceConfig& config, const json& value) { config.log_level = value; }}}};
}

Section archive_settings() {
    Param rules = Param::list("retention",
                              "which reports are removed; the first rule whose tag a report has decides about it, and "
                              "pinned and accepted reports are always kept",
                              retention_fields(), 0, 100);
    return {
        "archive",
        "the archive's reports",
        {{rules, [](ServiceConfig& config, const json& value) { config.retention = retention_rules(value); }},
         seconds("retention_interval_s", "time between two removals", week_s, at(&ServiceConfig::retention_interval))}};
}

Section http_settings() {
    using http::AnswerLimits, http::Limits;
    const auto of_connections = [](auto member) { return in(&ServiceConfig::http, member); };
    const auto of_answers = [](auto member) { return in(&ServiceConfig::answers, member); };
    return {
        "http",
        "limits for connections",
        {integer("max_connections", "simultaneous connections; if all are busy, further ones get 503", "", 1, 100'000,
                 of_connections(&Limits::max_connections)),
         integer("max_streams_per_client",
                 "simultaneous streams of events and waiting requests from one client's address", "", 1, 100'000,
                 of_connections(&Limits::max_streams_per_client)),
         integer("threads", "threads that make answers", "", 1, 64, of_connections(&Limits::threads)),
         bytes("header_bytes", "size of a request's header; longer ones get 431", kibibyte, mebibyte,
               of_connections(&Limits::header_bytes)),
         bytes("body_bytes", "size of a request's body; longer ones get 413", kibibyte, gibibyte,
               of_connections(&Limits::body_bytes)),
         bytes("drain_bytes", "part of a too long body that is read and dropped, so that its sender sees the 413", 0,
               16 * gibibyte, of_connections(&Limits::drain_bytes)),
         bytes("spool_bytes",
               "uploads on their way, all together, which are in `scratch/` until they are complete; beyond it they "
               "get 503",
               mebibyte, 1024 * gibibyte, of_connections(&Limits::spool_bytes)),
         seconds("idle_timeout_s", "time between two requests on a connection", day_s,
                 of_connections(&Limits::idle_timeout)),
         seconds("header_timeout_s", "time for a request's header to arrive", day_s,
                 of_connections(&Limits::header_timeout)),
         seconds("body_timeout_s", "time for a request's body to arrive", day_s, of_connections(&Limits::body_timeout)),
         seconds("write_timeout_s", "time for the other side to accept a piece of an answer", day_s,
                 of_connections(&Limits::write_timeout)),
         seconds("event_heartbeat_s", "time between two signs of life in a stream of events", day_s,
                 of_connections(&Limits::event_heartbeat)),
         seconds("stop_timeout_s", "time for pending answers when the service stops", day_s,
                 of_connections(&Limits::stop_timeout)),
         whole_seconds("max_wait_s", "longest wait that `Prefer: wait` can request", 0, day_s,
                       of_answers(&AnswerLimits::max_wait)),
         whole_seconds("ready_within_s", "how long after a worker's last rendering `/readyz` reports readiness", 1,
                       day_s, of_answers(&AnswerLimits::ready_within)),
         whole_seconds("devices_cache_s", "how long the list of devices is kept", 0, day_s,
                       at(&ServiceConfig::devices_cache))}};
}

Section jobs_settings() {
    const auto of_leases = [](auto member) { return in(&ServiceConfig::leases, member); };
    const auto of_job = [](auto member) {
        return [member](ServiceConfig & config) -> auto& {
            return config.answers.job.*member;
        };
    };
    using http::JobLimits;
    return {"jobs",
            "the queue, and what one comparison may ask for",
            {integer("max_queued", "jobs that may wait", "", 0, 1'000'000,
                     in(&ServiceConfig::answers, &http::AnswerLimits::max_queued)),
             integer("max_queued_cost",
                     "megapixels that may wait, in the measure of `max_cost`; one comparison alone may be more", "Mpx",
                     1, 1e15, in(&ServiceConfig::answers, &http::AnswerLimits::max_queued_cost)),
             integer("max_pixels", "pixels of a picture", "", 1, 4096.0 * 4096, of_job(&JobLimits::max_pixels)),
             integer("max_methods", "methods of a comparison", "", 1, 64, of_job(&JobLimits::max_methods)),
             integer("max_points", "points of a sweep", "", 1, 256, of_job(&JobLimits::max_points)),
             integer("max_cost",
                     "megapixels that a comparison draws: width x height of a picture, for each method and the "
                     "reference, each round and each point",
                     "Mpx", 1, 1e12, of_job(&JobLimits::max_cost)),
             seconds("lease_s", "how long a worker without a sign of life keeps its job; longer than `heartbeat_s`",
                     day_s, of_leases(&LeaseRules::lease_ms)),
             seconds("heartbeat_s", "time between two signs of life", day_s, of_leases(&LeaseRules::heartbeat_ms)),
             integer("max_attempts", "how many times a job is tried if its worker or renderer dies", "", 1, 10,
                     of_leases(&LeaseRules::max_attempts))}};
}

Section assets_settings() {
    const auto of_check = [](auto member) { return in(&ServiceConfig::upload_check, member); };
    return {"assets",
            "uploaded files",
            {bytes("max_bytes", "size of an uploaded file; longer ones get 413", kibibyte, gibibyte,
                   in(&ServiceConfig::answers, &http::AnswerLimits::max_asset_bytes)),
             bytes("check_memory_bytes", "address space of the process that reads an upload; 0 for no limit", 0,
                   tebibyte, of_check(&ChildLimits::memory_bytes)),
             seconds("check_time_s", "time for reading an upload", hour_s, of_check(&ChildLimits::time))}};
}

Section worker_settings() {
    const auto of_worker = [](auto member) { return in(&ServiceConfig::worker, member); };
    return {"worker",
            "the processes that render",
            {{Param::text("device",
                          "label of the workers that this service starts: a spec whose `device` it is goes to one of "
                          "them",
                          WorkerOptions().label, 100),
              [](ServiceConfig& config, const json& value) { config.worker.label = value; }},
             {Param::text("renders_on",
                          "the device on which they render: an index, or a part of the name of its renderer, as "
                          "`sheer devices` lists them; empty for the first GPU, or else the first software renderer",
                          "", 200),
              [](ServiceConfig& config, const json& value) { config.worker.renders_on = value; }},
             bytes("memory_limit_bytes", "address space of a renderer; 0 for no limit", 0, tebibyte,
                   of_worker(&WorkerOptions::memory_limit_bytes)),
             bytes("output_limit_bytes", "size of all files that a renderer writes; 0 for no limit", 0, tebibyte,
                   of_worker(&WorkerOptions::output_limit_bytes)),
             seconds("time_limit_s", "time for one job", week_s, of_worker(&WorkerOptions::time_limit)),
             seconds("pixel_time_limit_s", "time for explaining one pixel of a report, or for comparing two reports",
                     hour_s, in(&ServiceConfig::question, &ChildLimits::time)),
             seconds("poll_s",
                     "time between two checks of the queue; the workers of a PostgreSQL store are told of new jobs", 60,
                     of_worker(&WorkerOptions::poll_interval)),
             seconds("probe_interval_s", "time between two probes of an idle worker, each of which renders one pixel",
                     day_s, of_worker(&WorkerOptions::probe_interval))}};
}

Setting flag(std::string name, std::string summary, bool SandboxSettings::*member) {
    return {Param::boolean(std::move(name), std::move(summary), SandboxSettings().*member),
            [member](ServiceConfig& config, const json& value) { config.sandbox.*member = value.get<bool>(); }};
}

Section sandbox_settings() {
    Param readable{.name = "readable",
                   .kind = Param::Kind::any,
                   .summary = "folders and files that drivers read, besides those below /usr, /lib, /etc and /sys"};
    readable.default_value = json::array();
    return {"sandbox",
            "what confines the processes that read files and programs from others: docs/security.md",
            {flag("enabled", "whether they are confined", &SandboxSettings::enabled),
             flag("required", "whether uploads and the user's own GLSL are refused where there is no sandbox",
                  &SandboxSettings::required),
             {readable, [](ServiceConfig& config, const json& value) {
                  config.sandbox.readable = value.get<std::vector<std::string>>();
              }}}};
}

std::vector<Section> all_settings() {
    return {general_settings(), http_settings(),   jobs_settings(),   assets_settings(),
            archive_settings(), worker_settings(), sandbox_settings()};
}

void check_texts(const std::string& pointer, const json& texts, std::vector<FieldError>& errors,
                 const std::function<std::string(const std::string&)>& wrong) {
    if (!texts.is_array()) errors.push_back({pointer, "must be an array of texts"});
    for (std::size_t i = 0; texts.is_array() && i < texts.size(); ++i) {
        const std::string what = texts[i].is_string() ? wrong(texts[i]) : "must be a text";
        if (!what.empty()) errors.push_back({fmt::format("{}/{}", pointer, i), what});
    }
}

}  // namespace

std::vector<Param> service_config_fields() {
    std::vector<Param> fields;
    for (const Section& section : all_settings()) {
        std::vector<Param> below;
        for (const Setting& setting : section.settings) below.push_back(setting.param);
        if (section.name.empty()) {
            fields = std::move(below);
        } else {
            fields.push_back(Param::object(section.name, section.summary, std::move(below)));
        }
    }
    return fields;
}

ServiceConfig read_service_config(const json& document) {
    if (!document.is_object()) throw SpecError(std::vector<FieldError>{{"", "must be a JSON object"}});
    std::vector<FieldError> errors;
    const json read = read_fields(document, "", service_config_fields(), errors);
    check_texts("/allowed_hosts", read["allowed_hosts"], errors, [](const std::string&) { return ""; });
    check_texts("/sandbox/readable", read["sandbox"]["readable"], errors, [](const std::string&) { return ""; });
    check_texts("/cors_origins", read["cors_origins"], errors, http::wrong_origin);
    if (errors.empty()) check_retention(read["archive"]["retention"], "/archive/retention", errors);
    if (errors.empty())
        if (const std::string wrong = http::wrong_path_prefix(read["path_prefix"].get<std::string>()); !wrong.empty())
            errors.push_back({"/path_prefix", wrong});
    if (const std::string store = read["store"].is_string() ? read["store"].get<std::string>() : "";
        !store.empty() && !postgres::is_postgres_url(store))
        errors.push_back({"/store", "must begin with postgresql://"});
    if (errors.empty() && read["jobs"]["lease_s"] <= read["jobs"]["heartbeat_s"])
        errors.push_back({"/jobs/lease_s", "must be longer than heartbeat_s"});
    if (!errors.empty()) throw SpecError(std::move(errors));
    ServiceConfig config;
    for (const Section& section : all_settings())
        for (const Setting& setting : section.settings)
            setting.set(config, (section.name.empty() ? read : read[section.name])[setting.param.name]);
    config.worker.rules = config.leases;
    config.worker.sandbox = config.upload_check.sandbox = config.question.sandbox = config.sandbox;
    config.worker.fork_server = config.upload_check.fork_server = config.question.fork_server =
        std::make_shared<ForkServer>(rendering_program());
    config.question.memory_bytes = config.worker.memory_limit_bytes;
    config.answers.max_checks = config.answers.max_diffs = std::max(1, config.http.threads / 2);
    return config;
}

namespace {

ServiceConfig read_service_file(const std::filesystem::path& path, const json& overrides) {
    std::ifstream file(path);
    if (!file) throw SpecError(std::vector<FieldError>{{"", "cannot read " + path.string()}});
    json document = json::parse(file, nullptr, false, true);
    if (document.is_discarded()) throw SpecError(std::vector<FieldError>{{"", path.string() + " is not JSON"}});
    if (document.is_object()) document.update(overrides);
    return read_service_config(document);
}

}  // namespace

ServiceConfig load_service_config(const std::filesystem::path& path, const json& overrides) {
    if (path.empty()) return read_service_config(overrides);
    try {
        return read_service_file(path, overrides);
    } catch (const SpecError& wrong) {
        throw WrongFile(path.string(), wrong);
    }
}

}  // namespace sheer::cli
