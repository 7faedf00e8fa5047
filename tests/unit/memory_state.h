#pragma once
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "memory_store.h"
#include "server/jobs/facets.h"

namespace sheer::test::memory_store {

/// A report or the job that will become one, with the store's internal data.
struct Job {
    ReportRecord record;
    Facets facets;
    std::optional<IdempotencyKey> idempotency;
    std::optional<Sender> sender;
    double cost_mpx = 0;
    std::string owner;
    int attempts = 0, setbacks = 0;
    std::int64_t lease_until_ms = 0, not_before_ms = 0;
    bool cancel_requested = false, lacks_room = false;
    std::optional<int> died_of;
    std::vector<BlobName> blobs;
    std::vector<std::string> labels;  ///< of the workers that may run it now
    int parts = 0;
    std::vector<EndedPart> ended;
    std::string part;  ///< the one that runs
};

struct Bytes {
    std::string media_type, bytes;
};

struct KeptAsset {
    Asset asset;
    std::string bytes;
    std::uint64_t order = 0;
};

}  // namespace sheer::test::memory_store

namespace sheer::test {

struct MemoryState {
    /// Called before each call of a store, on its thread: to observe callers, or to delay them.
    std::function<void()> on_call = [] {};
    std::mutex mutex;
    std::condition_variable written;
    std::uint64_t writes = 0;
    std::map<std::string, memory_store::Job> jobs;
    std::map<std::string, memory_store::Bytes> blobs;
    std::map<std::string, memory_store::KeptAsset> assets;
    std::uint64_t assets_added = 0;
    std::vector<AcceptedReport> accepted;
    std::map<std::string, Pin> pins;
    std::map<std::string, SeenWorker> workers;
    std::map<std::pair<std::string, std::int64_t>, TokenUse> token_hours;
    std::optional<std::int64_t> last_rendered_ms;
};

}  // namespace sheer::test

namespace sheer::test::memory_store {

/// The state, locked for exclusive use.
class Reading {
  public:
    explicit Reading(MemoryState& state) : m_state(called(state)), m_lock(state.mutex) {}
    MemoryState* operator->() const { return &m_state; }

  protected:
    MemoryState& m_state;

  private:
    static MemoryState& called(MemoryState& state) {
        state.on_call();
        return state;
    }

    const std::lock_guard<std::mutex> m_lock;
};

/// The same for calls that change it, or may do so.
class Writing : public Reading {
  public:
    explicit Writing(MemoryState& state) : Reading(state) {}
    ~Writing() {
        ++m_state.writes;
        m_state.written.notify_all();
    }
};

struct Base {
    std::shared_ptr<MemoryState> state;
    LeaseRules rules;
    ClockMs clock;
};

std::string lack_of_room(const Reading& state, std::int64_t now_ms);
void requeue(Job& job, int attempts);
void end_attempt(Job& job, const JobError& error, Status status, std::int64_t now_ms);

TokenUse use_of(const Reading& state, std::int64_t now_ms, const std::string& token);

std::unique_ptr<JobQueue> make_queue(const Base& base);

}  // namespace sheer::test::memory_store
