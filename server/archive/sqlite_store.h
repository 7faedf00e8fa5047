#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <mutex>

#include "server/archive/blob_store.h"
#include "server/jobs/clock.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/store.h"

namespace sheer {

/// The store in one folder of this machine: FOLDER/archive.sqlite (WAL, synchronous=FULL), FOLDER/blobs and
/// FOLDER/assets.
///
/// A call takes well under a millisecond, except that one that writes waits for the disk; so callers keep it off the
/// thread that serves connections.
class SqliteStore : public Store {
  public:
    /// Makes what is missing. Throws StoreError, also for an archive of another version.
    SqliteStore(const std::filesystem::path& folder, LeaseRules rules, ClockMs clock);

    SubmitResult submit(const NewReport& report, std::size_t max_queued) override;
    std::optional<ReportRecord> find(const std::string& id) override;
    ReportPage list(const ListFilter& filter) override;
    RemoveResult remove(const std::string& id) override;
    std::optional<Blob> find_blob(const std::string& sha256) override;
    void add_asset(const Asset& asset, const std::string& bytes) override;
    std::optional<Asset> find_asset(const std::string& sha256) override;
    std::vector<Asset> list_assets(int limit) override;
    RemoveAssetResult remove_asset(const std::string& sha256) override;
    std::int64_t change_counter() override;
    std::optional<std::int64_t> last_rendered_ms() override;

    std::optional<Lease> lease(const std::string& owner) override;
    LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) override;
    LeaseState state(const Lease& lease) override;
    bool commit(const Lease& lease, const FinishedReport& finished) override;
    void fail(const Lease& lease, const JobError& error, bool retry) override;
    void cancel(const Lease& lease) override;
    void release(const Lease& lease) override;
    void end_leases_of(const std::string& owner) override;
    void note_rendered() override;

  private:
    void migrate();
    Asset read_asset(SQLite::Statement& row) const;
    void put_blobs(const std::vector<BlobFile>& blobs);
    void insert_report(const NewReport& report);
    void remove_blobs(const std::vector<std::string>& candidates);

    // These run inside the caller's transaction.
    void end_attempt(const std::string& id, const JobError& error, Status status);
    void requeue(const std::string& id, int attempts);
    void end_lost_leases(const std::string& condition, const std::string& value);
    void write_rendered();

    LeaseRules m_rules;
    ClockMs m_clock;
    BlobStore m_blobs, m_assets;
    std::mutex m_mutex;  ///< guards m_database
    SQLite::Database m_database;
    std::mutex m_watch_mutex;  ///< guards m_watch
    /// Never writes, so that its `data_version` moves with every commit of any other connection.
    SQLite::Database m_watch;
};

}  // namespace sheer
