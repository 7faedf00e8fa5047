#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "renderer/core/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"

namespace sheer {

/// The store in a PostgreSQL database, for services and workers on many machines. Pictures and uploads are in the
/// database too; a folder of this machine has copies of those that its child processes read.
///
/// Time is that of the database. A call takes a few round trips to it, and one that writes waits for its disk. Every
/// call throws StoreUnreachable while there is no connection, and connects again by itself. No message contains the
/// password.
class PostgresStore : public Store {
  public:
    /// Makes or updates the schema `sheer`. `url`: see postgres::Address. `made_up_clock`: for tests, instead of the
    /// database's. Throws StoreError, see postgres::migrate().
    PostgresStore(const std::string& url, const std::filesystem::path& folder, LeaseRules rules,
                  std::optional<ClockMs> made_up_clock = std::nullopt);
    ~PostgresStore() override;

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
    std::unique_ptr<ChangeWatch> watch_jobs() override;
    void bring_here(const std::string& text) override;

  private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace sheer
