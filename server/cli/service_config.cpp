#include "server/cli/service_config.h"

#include <fmt/format.h>

#include <fstream>

namespace sheer::cli {

using nlohmann::json;

namespace {

constexpr double gibibyte = 1024.0 * 1024 * 1024;
constexpr double day_s = 86'400;

Param seconds(std::string name, std::string summary, double fallback, double max_s) {
    return Param::number(std::move(name), std::move(summary), "s", fallback, 0.05, max_s);
}

std::vector<Param> http_fields() {
    const http::Limits limits;
    return {
        Param::integer("max_connections", "connections at a time", "", limits.max_connections, 1, 100'000),
        Param::integer("max_streams_per_client",
                       "streams of events and waiting requests of one client's address at a time", "",
                       limits.max_streams_per_client, 1, 100'000),
        Param::integer("threads", "threads that make answers", "", limits.threads, 1, 64),
        Param::integer("header_bytes", "size of a request's header", "byte", limits.header_bytes, 1024, 1 << 20),
        Param::integer("body_bytes", "size of a request's body", "byte", static_cast<long long>(limits.body_bytes),
                       1024, gibibyte),
        Param::integer("drain_bytes", "what is read and dropped of a body that is too long", "byte",
                       static_cast<long long>(limits.drain_bytes), 0, 16 * gibibyte),
        seconds("idle_timeout_s", "between two requests of a connection", 60, day_s),
        seconds("header_timeout_s", "for a request's header", 10, day_s),
        seconds("body_timeout_s", "for a request's body", 30, day_s),
        seconds("write_timeout_s", "for the other side to take a piece of an answer", 30, day_s),
        seconds("event_heartbeat_s", "between two signs of life in a stream of events", 15, day_s),
        seconds("stop_timeout_s", "for answers on their way when the service stops", 5, day_s),
        Param::integer("max_wait_s", "what `Prefer: wait` is cut to", "s", 300, 0, day_s),
        Param::integer("ready_within_s", "how long after a worker's last rendering the service counts as ready", "s",
                       90, 1, day_s),
        Param::integer("devices_cache_s", "how long the list of devices is kept", "s", 60, 0, day_s),
    };
}

std::vector<Param> jobs_fields() {
    const LeaseRules rules;
    return {Param::integer("max_queued", "jobs that may wait", "", 100, 0, 1'000'000),
            seconds("lease_s", "how long a worker that gives no sign of life keeps its job", 10, day_s),
            seconds("heartbeat_s", "between two signs of life", 1, day_s),
            Param::integer("max_attempts", "how often a job is tried whose worker or renderer dies", "",
                           rules.max_attempts, 1, 10)};
}

std::vector<Param> assets_fields() {
    const UploadCheckOptions check;
    return {Param::integer("max_bytes", "size of an uploaded file", "byte", 64 << 20, 1024, gibibyte),
            Param::integer("check_memory_bytes", "address space of the process that reads an upload; 0 for no limit",
                           "byte", static_cast<long long>(check.memory_limit_bytes), 0, 1024 * gibibyte),
            seconds("check_time_s", "for reading an upload", 20, 3600)};
}

std::vector<Param> worker_fields() {
    return {Param::integer("memory_limit_bytes", "address space of a renderer; 0 for no limit", "byte",
                           static_cast<long long>(8 * gibibyte), 0, 1024 * gibibyte),
            seconds("time_limit_s", "for one job", 1800, 7 * day_s),
            seconds("pixel_time_limit_s", "for taking one pixel of a report apart", 60, 3600),
            seconds("poll_s", "between two looks into the queue", 0.15, 60),
            seconds("probe_interval_s", "between two probes of an idle worker", 30, day_s)};
}

std::set<std::string> read_hosts(const json& hosts, std::vector<FieldError>& errors) {
    std::set<std::string> names;
    if (!hosts.is_array()) errors.push_back({"/allowed_hosts", "must be an array of names"});
    for (std::size_t i = 0; hosts.is_array() && i < hosts.size(); ++i) {
        if (hosts[i].is_string()) {
            names.insert(hosts[i].get<std::string>());
        } else {
            errors.push_back({fmt::format("/allowed_hosts/{}", i), "must be a text"});
        }
    }
    return names;
}

std::chrono::milliseconds ms_of(const json& seconds) {
    return std::chrono::milliseconds(static_cast<std::int64_t>(seconds.get<double>() * 1000));
}

http::Limits limits_of(const json& read) {
    http::Limits limits;
    limits.max_connections = read["max_connections"];
    limits.max_streams_per_client = read["max_streams_per_client"];
    limits.threads = read["threads"];
    limits.header_bytes = read["header_bytes"];
    limits.body_bytes = read["body_bytes"];
    limits.drain_bytes = read["drain_bytes"];
    limits.idle_timeout = ms_of(read["idle_timeout_s"]);
    limits.header_timeout = ms_of(read["header_timeout_s"]);
    limits.body_timeout = ms_of(read["body_timeout_s"]);
    limits.write_timeout = ms_of(read["write_timeout_s"]);
    limits.event_heartbeat = ms_of(read["event_heartbeat_s"]);
    limits.stop_timeout = ms_of(read["stop_timeout_s"]);
    return limits;
}

}  // namespace

std::vector<Param> service_config_fields() {
    Param hosts{.name = "allowed_hosts", .kind = Param::Kind::any, .summary = "names that the service answers for"};
    hosts.default_value = json::array();
    return {Param::text("listen", "ADDRESS:PORT; port 0 for any that is free", "127.0.0.1:8080", 200),
            Param::text("data", "folder of the archive", "sheer-data", 4096),
            Param::integer("workers", "worker processes; 0 for none", "", 1, 0, 256),
            std::move(hosts),
            Param::choice("log_level", "what the log tells; read again on SIGHUP", "info",
                          {"debug", "info", "warning", "error"}),
            Param::object("http", "what connections may take", http_fields()),
            Param::object("jobs", "the queue", jobs_fields()),
            Param::object("assets", "uploaded files", assets_fields()),
            Param::object("worker", "the processes that render", worker_fields())};
}

ServiceConfig read_service_config(const json& document) {
    if (!document.is_object()) throw SpecError(std::vector<FieldError>{{"", "must be a JSON object"}});
    std::vector<FieldError> errors;
    const json read = read_fields(document, "", service_config_fields(), errors);
    std::set<std::string> hosts = read_hosts(read["allowed_hosts"], errors);
    if (errors.empty() && read["jobs"]["lease_s"] <= read["jobs"]["heartbeat_s"])
        errors.push_back({"/jobs/lease_s", "must be longer than heartbeat_s"});
    if (!errors.empty()) throw SpecError(std::move(errors));
    ServiceConfig config{.listen = read["listen"], .data = read["data"].get<std::string>(), .workers = read["workers"]};
    config.allowed_hosts = std::move(hosts);
    config.log_level = read["log_level"];
    config.http = limits_of(read["http"]);
    config.max_queued = read["jobs"]["max_queued"];
    config.max_wait = std::chrono::seconds(read["http"]["max_wait_s"].get<int>());
    config.ready_within = std::chrono::seconds(read["http"]["ready_within_s"].get<int>());
    config.devices_cache = std::chrono::seconds(read["http"]["devices_cache_s"].get<int>());
    config.leases = {.lease_ms = ms_of(read["jobs"]["lease_s"]).count(),
                     .heartbeat_ms = ms_of(read["jobs"]["heartbeat_s"]).count(),
                     .max_attempts = read["jobs"]["max_attempts"]};
    config.max_asset_bytes = read["assets"]["max_bytes"];
    config.upload_check.memory_limit_bytes = read["assets"]["check_memory_bytes"];
    config.upload_check.time_limit = ms_of(read["assets"]["check_time_s"]);
    config.worker.rules = config.leases;
    config.worker.memory_limit_bytes = read["worker"]["memory_limit_bytes"];
    config.worker.time_limit = ms_of(read["worker"]["time_limit_s"]);
    config.pixel_time_limit = ms_of(read["worker"]["pixel_time_limit_s"]);
    config.worker.poll_interval = ms_of(read["worker"]["poll_s"]);
    config.worker.probe_interval = ms_of(read["worker"]["probe_interval_s"]);
    return config;
}

ServiceConfig load_service_config(const std::filesystem::path& path) {
    if (path.empty()) return read_service_config(json::object());
    std::ifstream file(path);
    if (!file) throw SpecError(std::vector<FieldError>{{"", "cannot read " + path.string()}});
    const json document = json::parse(file, nullptr, false, true);
    if (document.is_discarded()) throw SpecError(std::vector<FieldError>{{"", path.string() + " is not JSON"}});
    return read_service_config(document);
}

}  // namespace sheer::cli
