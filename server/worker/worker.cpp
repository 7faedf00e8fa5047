#include "server/worker/worker.h"

#include <spdlog/spdlog.h>

#include "renderer/core/exit_codes.h"
#include "server/process/run_child.h"
#include "server/worker/attempt.h"
#include "server/worker/scratch.h"

namespace sheer {

namespace {

constexpr std::chrono::seconds probe_time_limit{30};
constexpr std::chrono::milliseconds disk_pause{500};

}  // namespace

Worker::Worker(Store& store, WorkerOptions options, ClockMs clock)
    : m_store(store), m_options(std::move(options)), m_clock(std::move(clock)) {}

void Worker::run(StopSignal& stop) {
    sweep_scratch(m_options.scratch, m_store.reports());
    while (!stop.requested()) {
        try {
            work(stop);
        } catch (const DiskError& error) {
            spdlog::error("the archive cannot be used: {}", error.what());
            wait_readable({stop.descriptor()}, static_cast<int>(disk_pause.count()));
        }
    }
}

void Worker::work(StopSignal& stop) {
    if (run_next(stop)) {
        m_next_probe = std::chrono::steady_clock::now() + m_options.probe_interval;
    } else if (std::chrono::steady_clock::now() >= m_next_probe) {
        m_next_probe = std::chrono::steady_clock::now() + m_options.probe_interval;
        probe(stop);
    } else {
        wait_readable({stop.descriptor()}, static_cast<int>(m_options.poll_interval.count()));
    }
}

bool Worker::run_next(StopSignal& stop) {
    const std::optional<Lease> lease = m_store.queue().lease(m_options.name);
    if (!lease) return false;
    attempt(*lease, stop);
    return true;
}

void Worker::attempt(const Lease& lease, StopSignal& stop) {
    try {
        Attempt(m_store, m_options, m_clock, lease, stop).run();
    } catch (const DiskError& error) {
        spdlog::error("job {}: {}", lease.id, error.what());
        const bool full = dynamic_cast<const StoreFull*>(&error) != nullptr;
        set_back(lease, {report_not_kept, full ? "The archive's disk is full." : "The archive's disk fails."}, full,
                 stop);
    } catch (const std::system_error& error) {
        // Errors of the scratch folder and of processes that could not be started.
        spdlog::error("job {}: {}", lease.id, error.what());
        set_back(lease, {report_not_kept, error.code().message() + "."}, means_full_disk(error.code()), stop);
    } catch (const std::exception& error) {
        spdlog::error("job {}: {}", lease.id, error.what());
        m_store.queue().fail(lease, {report_not_kept, "The service's log says why."}, true);
    }
}

void Worker::set_back(const Lease& lease, const JobError& error, bool lacks_room, StopSignal& stop) {
    while (!stop.requested()) {
        try {
            return m_store.queue().set_back(lease, error, lacks_room);
        } catch (const DiskError& again) {
            spdlog::error("job {} cannot be given back yet: {}", lease.id, again.what());
            wait_readable({stop.descriptor()}, static_cast<int>(disk_pause.count()));
        }
    }
}

void Worker::probe(StopSignal& stop) {
    ChildRun run;
    run.options.program = m_options.program;
    run.options.fork_server = m_options.fork_server;
    run.options.arguments = {"render", "--probe"};
    confine(run.options, m_options.sandbox);
    run.options.memory_limit_bytes = m_options.memory_limit_bytes;
    run.time_limit = probe_time_limit;
    run.wake_descriptor = stop.descriptor();
    run.keep_going = [&stop] { return !stop.requested(); };
    const ChildResult result = run_child(run);
    if (result.status.code == exit_ok) {
        m_store.readiness().note_rendered();
    } else if (!result.stopped) {
        spdlog::warn("this worker cannot render: exit code {}, signal {}{}", result.status.code, result.status.signal,
                     result.timed_out ? ", too slow" : "");
    }
}

}  // namespace sheer
