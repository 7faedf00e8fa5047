#pragma once
#include <memory>

#include "renderer/core/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"

namespace sheer::test {

/// Shared by several MemoryStores, as several processes share an archive.
struct MemoryState;
std::shared_ptr<MemoryState> make_memory_state();

/// A second implementation of the store, only in the memory of this process: it makes sure that the store's tests use
/// only the interface, and serves the tests of code that uses a store. Its room is unlimited.
class MemoryStore : public Store {
  public:
    MemoryStore(std::shared_ptr<MemoryState> state, LeaseRules rules, ClockMs clock);
    ~MemoryStore() override;

    JobQueue& queue() override;
    ReportArchive& reports() override;
    Blobs& blobs() override;
    Assets& assets() override;
    Baselines& baselines() override;
    Pins& pins() override;
    Readiness& readiness() override;
    Care& care() override;
    Trends& trends() override;
    Activity& activity() override;
    Workers& workers() override;
    Usage& usage() override;
    std::unique_ptr<ChangeWatch> watch() override;
    std::unique_ptr<ChangeWatch> watch_jobs() override { return nullptr; }
    void bring_here(const std::string&) override {}

  private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace sheer::test
