#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/jobs/job_queue.h"
#include "server/process/child_process.h"

namespace sheer {

struct SupervisorOptions {
    int workers = 1;
    std::string program = own_program;
    std::vector<std::string> arguments;         ///< of a worker; `--name NAME` is added
    std::vector<std::string> environment = {};  ///< of a worker, besides ours, as NAME=VALUE
    std::chrono::milliseconds first_backoff{100};
    std::chrono::milliseconds longest_backoff{10'000};
    std::chrono::milliseconds stop_time{10'000};  ///< how long a worker may take to give its job back
};

/// Starts the worker processes and restarts them when they die, with growing delays if they die at once.
class Supervisor {
  public:
    Supervisor(JobQueue& queue, SupervisorOptions options);
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;
    ~Supervisor() { stop(); }

    /// Asks the workers to give their jobs back and waits until they have ended.
    void stop();

  private:
    using SteadyTime = std::chrono::steady_clock::time_point;
    struct Slot {
        std::unique_ptr<ChildProcess> process;
        std::string name;
        SteadyTime started{};
        SteadyTime start_at{};
        std::chrono::milliseconds backoff{};
    };

    void watch();
    void tend(Slot& slot);
    void start(Slot& slot);
    void end_all(std::vector<Slot>& slots);
    void forget_leases(const std::string& name);

    JobQueue& m_queue;
    SupervisorOptions m_options;
    int m_started = 0;
    std::mutex m_mutex;
    std::condition_variable m_wake;
    bool m_stopping = false;  ///< guarded by m_mutex
    /// The workers are children of this thread: they get their signal when it ends, so it must live as long as they do.
    std::thread m_thread;
};

}  // namespace sheer
