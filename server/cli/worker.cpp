#include "server/worker/worker.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "server/cli/commands.h"
#include "server/cli/open_store.h"
#include "server/cli/service_config.h"
#include "server/storage/data_folder.h"

namespace sheer::cli {

namespace {

struct WorkerArguments {
    std::string data, store, name, config, label, renders_on;
};

/// Of this machine and process, at this time.
std::string unused_name() {
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    return fmt::format("{}-{}-{}", host.data(), getpid(), system_now_ms());
}

void work(const WorkerArguments& arguments) {
    StopSignal stop;
    log_to_stderr("worker");
    // Workers keep the level with which they started until the service is restarted.
    std::signal(SIGHUP, SIG_IGN);
    const ServiceConfig config = load_service_config(arguments.config);
    spdlog::set_level(spdlog::level::from_str(config.log_level));
    const std::string url = arguments.store.empty() ? config.store : arguments.store;
    const std::filesystem::path data = arguments.data.empty() ? config.data : std::filesystem::path(arguments.data);
    const std::unique_ptr<Store> store = open_store(url, data, config.leases);
    take_store_environment(url);
    WorkerOptions options = config.worker;
    options.scratch = DataFolder{data}.scratch();
    options.shaders = DataFolder{data}.shaders();
    options.data = data.string();
    // Renderers look there for the qualification of their device.
    setenv("SHEER_STATE", std::filesystem::absolute(data).c_str(), 1);
    options.name = arguments.name.empty() ? unused_name() : arguments.name;
    if (!arguments.label.empty()) options.label = arguments.label;
    if (!arguments.renders_on.empty()) options.renders_on = arguments.renders_on;
    Worker(*store, std::move(options), system_now_ms).run(stop);
}

}  // namespace

void add_worker(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<WorkerArguments>();
    CLI::App* command = app.add_subcommand("worker", "Render the jobs of a store, on any machine");
    command->add_option("--store", arguments->store, store_help)->envname(store_variable);
    command->add_option("--device", arguments->label,
                        fmt::format("Label: jobs whose spec has this `device` come to such workers, {} if not given",
                                    WorkerOptions().label));
    command->add_option("--renders-on", arguments->renders_on,
                        "Device to render on, as `sheer devices` lists them: an index, or a part of a name");
    command->add_option("--data", arguments->data,
                        fmt::format("Folder for files of this machine, or of the archive if there is no --store; {} if "
                                    "not given",
                                    ServiceConfig().data.string()));
    command->add_option("--name", arguments->name, "Name that no other worker has or has had");
    command->add_option("--config", arguments->config, "The service's JSON file");
    command->footer("Example: sheer worker --store postgresql://sheer@db.example/sheer --device nvidia");
    command->callback([arguments, &exit_code] {
        try {
            work(*arguments);
            exit_code = exit_ok;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer worker: {}\n", error.what());
            exit_code = exit_render_failed;
        }
    });
}

}  // namespace sheer::cli
