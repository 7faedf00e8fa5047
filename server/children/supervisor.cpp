#include "server/children/supervisor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>

#include "renderer/core/clock.h"
#include "server/jobs/store_errors.h"

namespace sheer {

using namespace std::chrono_literals;

namespace {

constexpr auto tick = 50ms;
constexpr auto long_life = 10s;

}  // namespace

Supervisor::Supervisor(JobQueue& queue, SupervisorOptions options)
    : m_queue(queue), m_options(std::move(options)), m_thread([this] { watch(); }) {}

void Supervisor::stop() {
    {
        const std::lock_guard lock(m_mutex);
        m_stopping = true;
    }
    m_wake.notify_all();
    if (m_thread.joinable()) m_thread.join();
}

void Supervisor::watch() {
    std::vector<Slot> slots(static_cast<std::size_t>(m_options.workers));
    std::unique_lock lock(m_mutex);
    while (!m_stopping) {
        lock.unlock();
        std::ranges::for_each(slots, [this](Slot& slot) { tend(slot); });
        lock.lock();
        m_wake.wait_for(lock, tick, [this] { return m_stopping; });
    }
    lock.unlock();
    end_all(slots);
}

void Supervisor::tend(Slot& slot) {
    const SteadyTime now = std::chrono::steady_clock::now();
    if (!slot.process) {
        if (now >= slot.start_at) start(slot);
        return;
    }
    const std::optional<ExitStatus> ended = slot.process->poll();
    if (!ended) return;
    slot.process.reset();
    const bool lived_long = now - slot.started >= long_life;
    slot.backoff = lived_long || slot.backoff == 0ms ? m_options.first_backoff
                                                     : std::min(2 * slot.backoff, m_options.longest_backoff);
    slot.start_at = now + slot.backoff;
    spdlog::error("worker {} ended (exit code {}, signal {}); the next starts in {} ms", slot.name, ended->code,
                  ended->signal, slot.backoff.count());
    forget_leases(slot.name);
}

void Supervisor::start(Slot& slot) {
    ChildOptions options{
        .program = m_options.program, .arguments = m_options.arguments, .environment = m_options.environment};
    slot.name = fmt::format("{}-{}-{}", getpid(), system_now_ms(), ++m_started);
    options.arguments.insert(options.arguments.end(), {"--name", slot.name});
    options.capture_output = false;
    // A worker whose service was killed gives its job back, which SIGKILL would prevent.
    options.signal_when_orphaned = SIGTERM;
    try {
        slot.process = std::make_unique<ChildProcess>(options);
        slot.started = std::chrono::steady_clock::now();
    } catch (const std::exception& error) {
        spdlog::error("a worker cannot be started: {}", error.what());
        slot.start_at = std::chrono::steady_clock::now() + m_options.longest_backoff;
    }
}

void Supervisor::end_all(std::vector<Slot>& slots) {
    for (Slot& slot : slots)
        if (slot.process) slot.process->signal(SIGTERM);
    const auto deadline = std::chrono::steady_clock::now() + m_options.stop_time;
    for (Slot& slot : slots) {
        if (!slot.process) continue;
        while (!slot.process->poll() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(10ms);
        slot.process.reset();
        forget_leases(slot.name);
    }
}

void Supervisor::forget_leases(const std::string& name) {
    try {
        m_queue.end_leases_of(name);
    } catch (const StoreError& error) {
        // The leases expire by themselves.
        spdlog::error("worker {}: {}", name, error.what());
    }
}

}  // namespace sheer
