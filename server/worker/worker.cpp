#include "server/worker/worker.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/core/exit_codes.h"
#include "server/process/run_child.h"
#include "server/worker/attempt.h"
#include "server/worker/scratch.h"

namespace sheer {

namespace {

constexpr std::chrono::seconds probe_time_limit{30};
constexpr std::chrono::milliseconds disk_pause{500};
/// A worker that is told of new jobs asks for those whose worker died, or whose time has come, only this often.
constexpr std::chrono::milliseconds unasked{2'000};

/// What the reader of a report is told of an error of the store.
std::string reason_of(const DiskError& error) {
    if (dynamic_cast<const StoreFull*>(&error) != nullptr) return "The archive's disk is full.";
    if (dynamic_cast<const StoreUnreachable*>(&error) != nullptr) return "The store cannot be reached.";
    return "The archive's disk fails.";
}

}  // namespace

Worker::Worker(Store& store, WorkerOptions options, ClockMs clock)
    : m_store(store), m_options(std::move(options)), m_clock(std::move(clock)) {}

void Worker::run(StopSignal& stop) {
    sweep_scratch(m_options.scratch, m_store.reports());
    m_watch = m_store.watch_jobs();
    show_up();
    while (!stop.requested()) {
        try {
            work(stop);
        } catch (const DiskError& error) {
            spdlog::error("the store cannot be used: {}", error.what());
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
        wait_for_job(stop);
    }
}

void Worker::wait_for_job(StopSignal& stop) {
    const int told = m_watch ? m_watch->descriptor() : -1;
    const auto wait = told >= 0 ? std::max(m_options.poll_interval, unasked) : m_options.poll_interval;
    wait_readable({stop.descriptor(), told}, static_cast<int>(wait.count()));
    if (m_watch) m_watch->wait(std::chrono::milliseconds(0));
}

void Worker::show_up() {
    try {
        m_store.workers().note({.name = m_options.name, .label = m_options.label, .driver = m_driver});
    } catch (const DiskError& error) {
        spdlog::warn("others do not see this worker: {}", error.what());
    }
}

bool Worker::run_next(StopSignal& stop) {
    const std::optional<Lease> lease = m_store.queue().lease(m_options.name, m_options.label);
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
        set_back(lease, {report_not_kept, reason_of(error)}, full, stop);
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
    add_device(run.options.arguments, m_options);
    run.on_line = [this](const std::string& line) {
        const nlohmann::json said = nlohmann::json::parse(line, nullptr, false);
        if (said.is_object() && said.contains("renderer")) m_driver = said.value("renderer", "");
    };
    confine(run.options, m_options.sandbox);
    run.options.memory_limit_bytes = m_options.memory_limit_bytes;
    run.time_limit = probe_time_limit;
    run.wake_descriptor = stop.descriptor();
    run.keep_going = [&stop] { return !stop.requested(); };
    const ChildResult result = run_child(run);
    if (result.status.code == exit_ok) {
        m_store.readiness().note_rendered();
        show_up();
    } else if (!result.stopped) {
        spdlog::warn("this worker cannot render: exit code {}, signal {}{}", result.status.code, result.status.signal,
                     result.timed_out ? ", too slow" : "");
    }
}

}  // namespace sheer
