#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <memory>

#include "server/children/device_list.h"
#include "server/children/shading_check.h"
#include "server/children/supervisor.h"
#include "server/cli/commands.h"
#include "server/cli/open_store.h"
#include "server/cli/service_config.h"
#include "server/cli/service_manager.h"
#include "server/http/application.h"
#include "server/http/observer.h"
#include "server/http/server.h"
#include "server/http/service.h"
#include "server/jobs/prune_timer.h"
#include "server/storage/data_folder.h"

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

SupervisorOptions supervisor_options(const ServiceConfig& config, const ServeOptions& options,
                                     std::vector<std::string> environment) {
    SupervisorOptions supervised{.workers = config.workers, .arguments = {"worker", "--data", config.data.string()}};
    supervised.environment = std::move(environment);
    if (!options.config.empty()) supervised.arguments.insert(supervised.arguments.end(), {"--config", options.config});
    return supervised;
}

/// What can change while the service runs.
struct Running {
    http::Observer& observer;
    PruneTimer& pruning;

    void apply(const ServiceConfig& config) const {
        spdlog::set_level(spdlog::level::from_str(config.log_level));
        observer.log(config.access_log);
        pruning.use(config.retention, config.retention_interval);
    }
};

/// On SIGHUP: applies the settings that can change while the service runs. A wrong file changes nothing.
void reload(const ServeOptions& options, const Running& running) {
    try {
        const ServiceConfig config = config_of(options);
        ServiceManager::reloading([&] { running.apply(config); });
        spdlog::info(
            "SIGHUP: the log level is {}; access_log and archive take effect now, other settings at the next start",
            config.log_level);
    } catch (const std::exception& error) {
        spdlog::error("SIGHUP: the configuration is not reloaded: {}", error.what());
    }
}

/// Why there is no sandbox here, "" if there is one; the log says it too.
std::string note_sandbox(const SandboxSettings& settings) {
    std::string reason = why_no_sandbox(settings);
    if (reason.empty()) {
        spdlog::info("what others send is read and rendered in a sandbox");
    } else {
        spdlog::warn("there is no sandbox: {}; {}", reason,
                     settings.required ? "uploads and the user's own GLSL are refused"
                                       : "uploads and the user's own GLSL are accepted, as sandbox.required is false");
    }
    return reason;
}

/// Throws UsageError if anybody on the network could use the service.
void require_tokens(bool is_open, KnownTokens& tokens, const ServiceConfig& config) {
    if (is_open || tokens.any()) return;
    throw UsageError(fmt::format(
        "{} can be reached from other machines, and there are no tokens in {}: everybody could use the service. Make "
        "one with `sheer token create NAME --data {}`; or say `--behind-proxy` if a proxy decides who may use it",
        config.listen, config.token_file().string(), config.data.string()));
}

void serve(const ServeOptions& options) {
    // Standard output is for programs; the log is for people.
    log_to_stderr("serve");
    const ServiceConfig config = config_of(options);
    spdlog::set_level(spdlog::level::from_str(config.log_level));
    const http::Endpoint endpoint = http::parse_endpoint(config.listen);
    KnownTokens tokens{TokenFile(config.token_file())};
    const bool is_open = http::is_loopback(endpoint) || config.behind_proxy;
    require_tokens(is_open, tokens, config);
    const std::unique_ptr<Store> opened = open_store(config.store, config.data, config.leases);
    Store& store = *opened;
    const std::vector<std::string> store_environment = take_store_environment(config.store);
    ReportIds ids(system_now_ms);
    DeviceList devices(config.devices_cache);
    ShadingCheckOptions shading_options;
    shading_options.child.memory_bytes = config.question.memory_bytes;
    shading_options.child.sandbox = config.question.sandbox;
    shading_options.child.fork_server = config.question.fork_server;
    ShadingCheck shadings(shading_options);
    http::Observer observer(&store);
    PruneTimer pruning(store, system_now_ms);
    const Running running{observer, pruning};
    running.apply(config);
    http::Service service{.store = store,
                          .ids = ids,
                          .clock = system_now_ms,
                          .list_devices = [&devices] { return devices.get(); },
                          .check_upload =
                              [&config](const std::string& bytes, const std::string& media_type) {
                                  return check_upload(bytes, media_type, config.upload_check);
                              },
                          .pixel =
                              [&config, &store](const std::string& report, const PixelPlace& place) {
                                  store.bring_here(report);
                                  return run_pixel_child(
                                      report, place, {config.data, DataFolder{config.data}.shaders()}, config.question);
                              },
                          .diff =
                              [&config, &store](const DiffQuestion& question) {
                                  store.bring_here(question.a.dump());
                                  store.bring_here(question.b.dump());
                                  return run_diff_child(question, config.data, config.question);
                              },
                          .limits = config.answers,
                          .without_sandbox = note_sandbox(config.sandbox),
                          .needs_sandbox = config.sandbox.required,
                          .check_shading = [&shadings](const std::string& glsl) { return shadings.messages(glsl); },
                          .scratch = DataFolder{config.data}.scratch(),
                          .path_prefix = config.path_prefix,
                          .metrics = [&observer] { return observer.metrics(); },
                          .access = http::Access(tokens, !is_open)};
    const http::Application application(
        http::make_guard(http::is_loopback(endpoint), config.allowed_hosts, config.cors_origins),
        http::make_router(service), http::PathPrefix(config.path_prefix), service.access);
    http::Server server(
        endpoint, config.http,
        {.answer = [&](http::Request request) { return observer.answer(application, std::move(request)); },
         .handling = [&](std::string_view method,
                         std::string_view target) { return application.handling(method, target); },
         .known = [&](const http::Request& request) { return observer.known(application, request); },
         .changes = store.watch(),
         .reload = [&options, &running] { reload(options, running); },
         .alive = ServiceManager::alive,
         .alive_interval = ServiceManager::watchdog_interval(),
         .spool = DataFolder{config.data}.scratch()});
    Supervisor workers(store.queue(), supervisor_options(config, options, store_environment));
    fmt::print("Sheer listens on {}{}\n", http::url_of(server.endpoint()), config.path_prefix);
    std::fflush(stdout);
    ServiceManager::ready("listens on " + http::url_of(server.endpoint()));
    server.run();
    ServiceManager::stopping();
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
    command
        ->add_option_function<std::string>(
            "--store", [options](const std::string& value) { options->overrides["store"] = value; }, store_help)
        ->envname(store_variable);
    command->add_option_function<int>(
        "--workers", [options](int value) { options->overrides["workers"] = value; },
        fmt::format("Worker processes, {} if not given", defaults.workers));
    command->add_flag_callback(
        "--behind-proxy", [options] { options->overrides["behind_proxy"] = true; },
        "A proxy decides who may use the service, which then needs no tokens beyond loopback");
    command->add_option("--config", options->config, "JSON file with any of the settings");
    command->footer("Example: sheer serve --listen 127.0.0.1:8080 --data sheer-data");
    command->callback([options, &exit_code] {
        try {
            serve(*options);
            exit_code = exit_ok;
        } catch (const WrongFile& error) {
            fmt::print(stderr, "sheer serve: {} is wrong:\n{}\n", error.path(), error.what());
            exit_code = exit_bad_spec;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer serve: {}\n", error.what());
            exit_code = exit_bad_spec;
        }
    });
}

}  // namespace sheer::cli
