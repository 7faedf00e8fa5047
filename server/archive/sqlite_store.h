#pragma once
#include <filesystem>
#include <memory>

#include "renderer/core/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"

namespace sheer {

/// The store in one folder of this machine (see DataFolder): a SQLite database (WAL, synchronous=FULL), and pictures
/// and uploads as files.
///
/// A call takes well under a millisecond, except that a call that writes waits for the disk and for other writers.
class SqliteStore : public Store {
  public:
    /// Makes what is missing. Throws StoreError, also for an archive of a newer version; see open_archive.
    SqliteStore(const std::filesystem::path& folder, LeaseRules rules, ClockMs clock);
    ~SqliteStore() override;

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
    std::optional<std::int64_t> version() override;
    std::unique_ptr<ChangeWatch> watch_jobs() override { return nullptr; }
    void bring_here(const std::string&) override {}

  private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace sheer
