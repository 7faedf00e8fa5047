#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "server/archive/sqlite_store.h"
#include "server/cli/commands.h"
#include "server/cli/service_config.h"
#include "server/http/application.h"
#include "server/http/server.h"
#include "server/http/service.h"
#include "server/worker/devices.h"
#include "server/worker/supervisor.h"

namespace sheer::cli {

namespace {

struct ServeOptions {
    std::string listen;
    std::string data;
    int workers = -1;
    std::string config;
};

ServiceConfig config_of(const ServeOptions& options) {
    ServiceConfig config = load_service_config(options.config);
    if (!options.listen.empty()) config.listen = options.listen;
    if (!options.data.empty()) config.data = options.data;
    if (options.workers >= 0) config.workers = options.workers;
    return config;
}

SupervisorOptions supervisor_options(const ServiceConfig& config, const ServeOptions& options) {
    SupervisorOptions supervised{.workers = config.workers, .arguments = {"worker", "--data", config.data.string()}};
    if (!options.config.empty()) supervised.arguments.insert(supervised.arguments.end(), {"--config", options.config});
    return supervised;
}

PixelOptions pixel_options(const ServiceConfig& config) {
    return {.data = config.data,
            .memory_limit_bytes = config.worker.memory_limit_bytes,
            .time_limit = config.pixel_time_limit};
}

/// On SIGHUP: what can change while everything else goes on. A file that is wrong changes nothing.
void reload(const ServeOptions& options) {
    try {
        const ServiceConfig config = config_of(options);
        spdlog::set_level(spdlog::level::from_str(config.log_level));
        spdlog::info("SIGHUP: the log level is {}; other settings wait for the next start", config.log_level);
    } catch (const std::exception& error) {
        spdlog::error("SIGHUP: the configuration is not read again: {}", error.what());
    }
}

void serve(const ServeOptions& options) {
    // What a program may want to read is on standard output; the log is for people.
    spdlog::set_default_logger(spdlog::stderr_color_mt("serve"));
    const ServiceConfig config = config_of(options);
    spdlog::set_level(spdlog::level::from_str(config.log_level));
    const http::Endpoint endpoint = http::parse_endpoint(config.listen);
    SqliteStore store(config.data, config.leases, system_now_ms);
    ReportIds ids(system_now_ms);
    DeviceList devices(config.devices_cache);
    http::Service service{.store = store,
                          .ids = ids,
                          .clock = system_now_ms,
                          .list_devices = [&devices] { return devices.get(); },
                          .check_upload =
                              [&config](const std::string& bytes, const std::string& media_type) {
                                  return check_upload(bytes, media_type, config.upload_check);
                              },
                          .take_pixel_apart =
                              [&config](const std::string& report, const PixelPlace& place) {
                                  return take_pixel_apart(report, place, pixel_options(config));
                              },
                          .max_asset_bytes = config.max_asset_bytes,
                          .max_checks = std::max(1, config.http.threads / 2),
                          .max_diffs = std::max(1, config.http.threads / 2),
                          .max_queued = config.max_queued,
                          .max_wait = config.max_wait,
                          .ready_within = config.ready_within};
    const http::Application application(http::make_guard(http::is_loopback(endpoint), config.allowed_hosts),
                                        http::make_router(service));
    http::Server server(endpoint, config.http,
                        {.answer = [&](http::Request request) { return application.answer(std::move(request)); },
                         .handling = [&](std::string_view method,
                                         std::string_view target) { return application.handling(method, target); },
                         .change_counter = [&store] { return store.change_counter(); },
                         .reload = [&options] { reload(options); }});
    Supervisor workers(store, supervisor_options(config, options));
    fmt::print("Sheer listens on {}\n", http::url_of(server.endpoint()));
    std::fflush(stdout);
    server.run();
}

}  // namespace

void add_serve(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "Start the service");
    command->add_option("--listen", options->listen, "ADDRESS:PORT, 127.0.0.1:8080 if not given");
    command->add_option("--data", options->data, "Folder of the archive, sheer-data if not given");
    command->add_option("--workers", options->workers, "Worker processes, 1 if not given")->check(CLI::Range(0, 256));
    command->add_option("--config", options->config, "JSON file with everything that can be set");
    command->callback([options, &exit_code] {
        try {
            serve(*options);
            exit_code = exit_ok;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer serve: {}\n", error.what());
            exit_code = exit_bad_spec;
        }
    });
}

}  // namespace sheer::cli
