#include "server/worker/attempt.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "renderer/core/errors.h"
#include "renderer/core/exit_codes.h"
#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "server/jobs/foreign_input.h"
#include "server/worker/against.h"
#include "server/worker/joining.h"
#include "server/worker/report_folder.h"
#include "server/worker/scratch.h"

namespace sheer {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

constexpr const char *spec_name = "spec.json", *out_name = "out";
// Each write of progress waits for the disk and so disturbs the timing.
constexpr auto progress_interval = 250ms;
constexpr auto question_interval = 200ms;
constexpr auto look_interval = 500ms;
constexpr auto commit_pause = 1s;
constexpr int most_commits = 30;

}  // namespace

Attempt::Attempt(Store& store, const WorkerOptions& options, const ClockMs& clock, const Lease& lease, StopSignal& stop)
    : m_store(store),
      m_queue(store.queue()),
      m_readiness(store.readiness()),
      m_options(options),
      m_clock(clock),
      m_lease(lease),
      m_stop(stop) {}

void Attempt::run() {
    if (m_lease.joins()) return join();
    render();
}

void Attempt::render() {
    const ScratchFolder scratch(m_options.scratch, m_lease.id, m_lease.attempt, m_lease.parts_ended);
    write_file(scratch.path() / spec_name, spec_to_render(m_lease));
    m_store.bring_here(m_lease.spec);
    spdlog::info("job {} starts, attempt {}", m_lease.id, m_lease.attempt);
    conclude(run_child(child_run(scratch.path())), scratch.path() / out_name);
}

void Attempt::join() {
    spdlog::info("the parts of job {} are joined, attempt {}", m_lease.id, m_lease.attempt);
    FinishedReport finished;
    std::future<void> joining = std::async(
        std::launch::async, [&] { finished = joined_report(m_store, m_lease, m_clock(), m_options.data, limits()); });
    wait_for(joining, "comparing the devices");
    const bool kept = commit(finished);
    spdlog::info("job {} {}", m_lease.id, kept ? "is done" : "was cancelled or taken over before it ended");
}

ChildLimits Attempt::limits() const {
    return {.memory_bytes = m_options.memory_limit_bytes,
            .time = m_options.time_limit,
            .program = m_options.program,
            .sandbox = m_options.sandbox,
            .fork_server = m_options.fork_server};
}

void Attempt::wait_for(std::future<void>& work, const std::string& stage) {
    m_progress.stage = stage;
    while (work.wait_for(std::chrono::milliseconds(m_options.rules.heartbeat_ms)) != std::future_status::ready)
        heartbeat();
    work.get();
}

void Attempt::heartbeat() {
    const bool has_prefix = !m_lease.part.empty() && !m_progress.stage.empty();
    const std::string prefix = has_prefix ? m_lease.part + ": " : "";
    const double progress = parts_progress(m_lease.parts_ended, m_lease.parts, m_progress.fraction);
    m_state = m_queue.heartbeat(m_lease, progress, prefix + m_progress.stage);
}

fs::path Attempt::shaders_in(const fs::path& scratch) const {
    if (m_options.shaders.empty() || !has_foreign_input(nlohmann::json::parse(m_lease.spec))) return m_options.shaders;
    const fs::path copy = scratch / "shaders";
    copy_shaders(m_options.shaders, copy);
    return copy;
}

ChildRun Attempt::child_run(const fs::path& scratch) {
    ChildRun run;
    const fs::path spec = scratch / spec_name, out = scratch / out_name;
    run.options.program = m_options.program;
    run.options.fork_server = m_options.fork_server;
    run.options.arguments = {"render", spec.string(), "--out", out.string(), "--data", m_options.data};
    if (const fs::path shaders = shaders_in(scratch); !shaders.empty())
        run.options.arguments.insert(run.options.arguments.end(), {"--shaders", shaders.string()});
    add_device(run.options.arguments, m_options);
    confine(run.options, m_options.sandbox);
    run.options.memory_limit_bytes = m_options.memory_limit_bytes;
    run.time_limit = m_options.time_limit;
    run.wake_descriptor = m_stop.descriptor();
    run.on_line = [this](const std::string& line) { read_line(line); };
    run.keep_going = [this, out] {
        m_wrote_too_much = writes_too_much(out);
        return !m_stop.requested() && !m_wrote_too_much && keep_lease();
    };
    return run;
}

void Attempt::read_line(const std::string& line) {
    const ChildMessage message = read_child_message(line);
    if (const auto* error = std::get_if<ChildError>(&message)) m_error = *error;
    if (const auto* progress = std::get_if<ChildProgress>(&message)) {
        m_rendered = m_rendered || progress->fraction > m_progress.fraction;
        m_progress = *progress;
        m_unsaved_progress = true;
    }
}

bool Attempt::writes_too_much(const fs::path& out) {
    const SteadyTime now = std::chrono::steady_clock::now();
    if (m_options.output_limit_bytes == 0 || now - m_last_look < look_interval) return false;
    m_last_look = now;
    std::uint64_t all_bytes = 0;
    std::error_code none;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(out, none)) {
        std::error_code gone;
        if (const auto bytes = file.file_size(gone); !gone) all_bytes += bytes;
    }
    return all_bytes > m_options.output_limit_bytes;
}

bool Attempt::keep_lease() {
    const SteadyTime now = std::chrono::steady_clock::now();
    const auto since_heartbeat = now - m_last_heartbeat;
    const bool due = since_heartbeat >= std::chrono::milliseconds(m_options.rules.heartbeat_ms) ||
                     (m_unsaved_progress && since_heartbeat >= progress_interval);
    if (due) {
        beat(now);
    } else if (now - m_last_question >= question_interval) {
        m_last_question = now;
        ask();
    }
    return m_state == LeaseState::held;
}

void Attempt::ask() {
    try {
        m_state = m_queue.state(m_lease);
    } catch (const StoreUnreachable&) {
        // The next heartbeat decides.
    }
}

/// A heartbeat that cannot be written does not stop the rendering as long as no other worker can have got the job.
void Attempt::beat(SteadyTime now) {
    m_last_heartbeat = now;
    try {
        heartbeat();
        if (m_rendered) m_readiness.note_rendered();
        m_unsaved_progress = m_rendered = false;
        m_lease_kept = now;
    } catch (const DiskError& error) {
        spdlog::warn("job {}: no heartbeat: {}", m_lease.id, error.what());
        if (now - m_lease_kept > std::chrono::milliseconds(m_options.rules.lease_ms)) m_state = LeaseState::lost;
    }
}

void Attempt::conclude(const ChildResult& result, const fs::path& out) {
    if (result.timed_out) {
        const auto limit_s = std::chrono::duration_cast<std::chrono::seconds>(m_options.time_limit).count();
        spdlog::warn("job {} was stopped after {} s", m_lease.id, limit_s);
        m_queue.fail(m_lease, {"Rendering took too long", fmt::format("It was stopped after {} s.", limit_s)}, false);
    } else if (result.stopped && m_wrote_too_much) {
        spdlog::warn("job {} was stopped since it wrote more than {} bytes", m_lease.id, m_options.output_limit_bytes);
        m_queue.fail(
            m_lease,
            {"Rendering wrote too much", fmt::format("It wrote more than {} bytes.", m_options.output_limit_bytes)},
            false);
    } else if (result.stopped && m_state == LeaseState::cancel_requested) {
        spdlog::info("job {} is cancelled", m_lease.id);
        m_queue.cancel(m_lease);
    } else if (result.stopped && m_state == LeaseState::lost) {
        spdlog::warn("job {} is no longer ours", m_lease.id);
    } else if (result.stopped) {
        spdlog::info("job {} goes back to the queue", m_lease.id);
        m_queue.release(m_lease);
    } else if (result.status.code == exit_ok || result.status.code == exit_check_failed) {
        const bool kept = commit(finished_report(out));
        const char* const done = m_lease.part.empty() ? "is done" : "has another part";
        spdlog::info("job {} {}", m_lease.id, kept ? done : "was cancelled or taken over before it ended");
    } else {
        conclude_failure(result.status);
    }
}

/// A short loss of the connection does not waste the rendering.
bool Attempt::commit(const FinishedReport& finished) {
    for (int tries = 0;; ++tries) {
        try {
            return m_queue.commit(m_lease, finished);
        } catch (const StoreUnreachable& error) {
            spdlog::warn("job {} is not committed: {}", m_lease.id, error.what());
            if (m_stop.requested() || tries == most_commits) throw;
            wait_readable({m_stop.descriptor()}, static_cast<int>(commit_pause.count()));
        }
    }
}

FinishedReport Attempt::finished_report(const fs::path& out) {
    Lease rendered = m_lease;
    rendered.spec = spec_to_render(m_lease);
    rendered.spec_sha256 = sha256_hex(rendered.spec);
    FinishedReport finished = read_report_folder(out, rendered, m_clock());
    // The pictures of a large sweep take longer than a lease.
    std::future<void> comparing = std::async(
        std::launch::async, [&] { compare_with_baseline(m_store, finished, out, m_options.data, limits()); });
    wait_for(comparing, "comparing with the baseline");
    return finished;
}

void Attempt::conclude_failure(const ExitStatus& status) {
    if (status.signal != 0) {
        spdlog::error("job {}: the renderer died (signal {})", m_lease.id, status.signal);
        m_queue.fail_by_signal(
            m_lease, {"Rendering failed", fmt::format("The renderer died (signal {}).", status.signal)}, status.signal);
        return;
    }
    const JobError unexplained{"Rendering failed", fmt::format("The renderer ended with exit code {}.", status.code)};
    const JobError error = m_error ? m_error->error : unexplained;
    spdlog::error("job {}: exit code {}: {}: {}", m_lease.id, status.code, error.title, error.detail);
    if (m_error && m_error->is_of_disk) return m_queue.set_back(m_lease, error, m_error->lacks_room);
    m_queue.fail(m_lease, error, false);
}

}  // namespace sheer
