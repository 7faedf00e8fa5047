#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <memory>

#include "server/archive/sqlite_store.h"
#include "server/children/device_list.h"
#include "server/children/shading_check.h"
#include "server/children/supervisor.h"
#include "server/cli/commands.h"
#include "server/cli/service_config.h"
#include "server/http/application.h"
#include "server/http/server.h"
#include "server/http/service.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

struct ServeOptions {
    std::string config;
    json overrides = json::object();  ///< fields of the configuration that the command line sets
};

ServiceConfig config_of(const ServeOptions& options) {
    return load_service_config(options.config, options.overrides);
}

SupervisorOptions supervisor_options(const ServiceConfig& config, const ServeOptions& options) {
    SupervisorOptions supervised{.workers = config.workers, .arguments = {"worker", "--data", config.data.string()}};
    if (!options.config.empty()) supervised.arguments.insert(supervised.arguments.end(), {"--config", options.config});
    return supervised;
}

/// On SIGHUP: applies the settings that can change while the service runs. A wrong file changes nothing.
void reload(const ServeOptions& options) {
    try {
        const ServiceConfig config = config_of(options);
        spdlog::set_level(spdlog::level::from_str(config.log_level));
        spdlog::info("SIGHUP: the log level is {}; other settings take effect at the next start", config.log_level);
    } catch (const std::exception& error) {
        spdlog::error("SIGHUP: the configuration is not reloaded: {}", error.what());
    }
}

void serve(const ServeOptions& options) {
    // Standard output is for programs; the log is for people.
    spdlog::set_default_logger(spdlog::stderr_color_mt("serve"));
    ServiceConfig config = config_of(options);
    spdlog::set_level(spdlog::level::from_str(config.log_level));
    config.pixel.data = config.data;
    const http::Endpoint endpoint = http::parse_endpoint(config.listen);
    SqliteStore store(config.data, config.leases, system_now_ms);
    ReportIds ids(system_now_ms);
    DeviceList devices(config.devices_cache);
    ShadingCheck shadings({.memory_limit_bytes = config.worker.memory_limit_bytes});
    http::Service service{
        .store = store,
        .ids = ids,
        .clock = system_now_ms,
        .list_devices = [&devices] { return devices.get(); },
        .check_upload =
            [&config](const std::string& bytes, const std::string& media_type) {
                return check_upload(bytes, media_type, config.upload_check);
            },
        .pixel = [&config](const std::string& report,
                           const PixelPlace& place) { return run_pixel_child(report, place, config.pixel); },
        .limits = config.answers,
        .check_shading = [&shadings](const std::string& glsl) { return shadings.messages(glsl); }};
    const http::Application application(http::make_guard(http::is_loopback(endpoint), config.allowed_hosts),
                                        http::make_router(service));
    http::Server server(endpoint, config.http,
                        {.answer = [&](http::Request request) { return application.answer(std::move(request)); },
                         .handling = [&](std::string_view method,
                                         std::string_view target) { return application.handling(method, target); },
                         .changes = store.watch(),
                         .reload = [&options] { reload(options); }});
    Supervisor workers(store.queue(), supervisor_options(config, options));
    fmt::print("Sheer listens on {}\n", http::url_of(server.endpoint()));
    std::fflush(stdout);
    server.run();
}

}  // namespace

void add_serve(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "Start the service");
    const ServiceConfig defaults;
    command->add_option_function<std::string>(
        "--listen", [options](const std::string& value) { options->overrides["listen"] = value; },
        fmt::format("ADDRESS:PORT, {} if not given", defaults.listen));
    command->add_option_function<std::string>(
        "--data", [options](const std::string& value) { options->overrides["data"] = value; },
        fmt::format("Folder of the archive, {} if not given", defaults.data.string()));
    command->add_option_function<int>(
        "--workers", [options](int value) { options->overrides["workers"] = value; },
        fmt::format("Worker processes, {} if not given", defaults.workers));
    command->add_option("--config", options->config, "JSON file with any of the settings");
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
