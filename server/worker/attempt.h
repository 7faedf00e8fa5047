#pragma once
#include <chrono>
#include <future>
#include <optional>

#include "server/process/ask_child.h"
#include "server/process/child_message.h"
#include "server/process/run_child.h"
#include "server/worker/worker.h"

namespace sheer {

/// One attempt at a leased job: renders in a child, keeps the lease meanwhile, and always ends the lease.
class Attempt {
  public:
    Attempt(Store& store, const WorkerOptions& options, const ClockMs& clock, const Lease& lease, StopSignal& stop);
    /// Throws what the store and the file system throw; the lease is then still held.
    void run();

  private:
    using SteadyTime = std::chrono::steady_clock::time_point;

    void render();
    /// The parts of a report of several devices.
    void join();
    ChildLimits limits() const;
    /// Waits for work that this process cannot stop, and keeps the lease meanwhile.
    void wait_for(std::future<void>& work, const std::string& stage);
    void heartbeat();
    ChildRun child_run(const std::filesystem::path& scratch);
    /// Where its driver finds and keeps compiled shaders: files and programs of others cannot leave anything in ours,
    /// so what reads them gets a copy. Empty for none.
    std::filesystem::path shaders_in(const std::filesystem::path& scratch) const;
    void read_line(const std::string& line);
    bool keep_lease();
    bool writes_too_much(const std::filesystem::path& out);
    void ask();
    bool commit(const FinishedReport& finished);
    void beat(SteadyTime now);
    void conclude(const ChildResult& result, const std::filesystem::path& out);
    /// The renderer's report, compared with the report of its `against`.
    FinishedReport finished_report(const std::filesystem::path& out);
    void conclude_failure(const ExitStatus& status);

    Store& m_store;
    JobQueue& m_queue;
    Readiness& m_readiness;
    const WorkerOptions& m_options;
    const ClockMs& m_clock;
    const Lease& m_lease;
    StopSignal& m_stop;
    ChildProgress m_progress;
    std::optional<ChildError> m_error;  ///< what the child said went wrong
    bool m_wrote_too_much = false;
    bool m_unsaved_progress = false;
    bool m_rendered = false;  ///< whether progress was made since the last heartbeat
    LeaseState m_state = LeaseState::held;
    SteadyTime m_last_heartbeat{};
    SteadyTime m_lease_kept = std::chrono::steady_clock::now();  ///< when the store last heard from us
    SteadyTime m_last_question{};
    SteadyTime m_last_look{};  ///< at the files of the renderer
};

}  // namespace sheer
