#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/core/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"
#include "server/process/child_process.h"
#include "server/process/rendering_program.h"
#include "server/process/sandbox_settings.h"
#include "server/process/stop_signal.h"

namespace sheer {

struct WorkerOptions {
    std::filesystem::path scratch;  ///< the folder that renderers write to
    std::filesystem::path shaders;  ///< the folder where drivers keep compiled shaders; empty for none
    std::string data;               ///< tells a renderer which store holds the uploaded files
    std::string name;               ///< unique among all workers that ever lived
    std::string label = "local";    ///< see JobQueue::lease()
    std::string renders_on;         ///< the renderer's --device; empty: it chooses
    std::string program = rendering_program();
    std::uint64_t memory_limit_bytes = std::uint64_t{8} << 30;   ///< of the rendering child; 0: none
    std::uint64_t output_limit_bytes = std::uint64_t{16} << 30;  ///< of all files that it writes; 0: none
    std::chrono::milliseconds time_limit{1'800'000};
    std::chrono::milliseconds poll_interval{150};
    std::chrono::milliseconds probe_interval{30'000};
    LeaseRules rules;
    SandboxSettings sandbox{.enabled = false};
    std::shared_ptr<ForkServer> fork_server = nullptr;  ///< of `program`, if any
};

/// Tells a renderer its device.
inline void add_device(std::vector<std::string>& arguments, const WorkerOptions& options) {
    if (!options.renders_on.empty()) arguments.insert(arguments.end(), {"--device", options.renders_on});
}

/// Leases jobs, renders each in a child process that may die, and commits the reports.
class Worker {
  public:
    Worker(Store& store, WorkerOptions options, ClockMs clock);

    /// Works until a stop is requested; a running job then goes back to the queue.
    void run(StopSignal& stop);
    /// Runs one job if there is one.
    bool run_next(StopSignal& stop);
    /// Renders one pixel and records the time if that works.
    void probe(StopSignal& stop);

  private:
    /// Does the next thing that is due, or waits.
    void work(StopSignal& stop);
    void attempt(const Lease& lease, StopSignal& stop);
    /// Until there may be a job, but not longer than until some other work may be due.
    void wait_for_job(StopSignal& stop);
    /// Tells the others that this worker is here.
    void show_up();
    /// Tries until the store accepts it or the lease is lost.
    void set_back(const Lease& lease, const JobError& error, bool lacks_room, StopSignal& stop);

    Store& m_store;
    WorkerOptions m_options;
    ClockMs m_clock;
    std::unique_ptr<ChangeWatch> m_watch;  ///< null if the queue has to be asked
    std::string m_driver;                  ///< the renderer that the last probe found
    std::chrono::steady_clock::time_point m_next_probe{};
};

}  // namespace sheer
