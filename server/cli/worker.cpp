#include "server/worker/worker.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "server/archive/sqlite_store.h"
#include "server/cli/commands.h"
#include "server/cli/service_config.h"
#include "server/storage/data_folder.h"

namespace sheer::cli {

namespace {

struct WorkerArguments {
    std::string data;
    std::string name;
    std::string config;
};

void work(const WorkerArguments& arguments) {
    StopSignal stop;
    log_to_stderr("worker");
    // Workers keep the level with which they started until the service is restarted.
    std::signal(SIGHUP, SIG_IGN);
    const ServiceConfig config = load_service_config(arguments.config);
    spdlog::set_level(spdlog::level::from_str(config.log_level));
    SqliteStore store(arguments.data, config.leases, system_now_ms);
    WorkerOptions options = config.worker;
    options.scratch = DataFolder{arguments.data}.scratch();
    options.data = arguments.data;
    // Renderers look there for the qualification of their device.
    setenv("SHEER_STATE", std::filesystem::absolute(arguments.data).c_str(), 1);
    options.name = arguments.name;
    Worker(store, std::move(options), system_now_ms).run(stop);
}

}  // namespace

void add_worker(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<WorkerArguments>();
    CLI::App* command = app.add_subcommand("worker", "Render the jobs of an archive")->group("");
    command->add_option("--data", arguments->data, "Folder of the archive")->required();
    command->add_option("--name", arguments->name, "Name that no other worker has or has had")->required();
    command->add_option("--config", arguments->config, "The service's JSON file");
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
