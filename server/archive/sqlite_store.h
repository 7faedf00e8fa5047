#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <atomic>
#include <filesystem>
#include <mutex>

#include "server/archive/blob_store.h"
#include "server/archive/disk_room.h"
#include "server/archive/sqlite_guard.h"
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
    /// Makes what is missing. Throws StoreError, also for an archive of a newer version; see open_archive.
    SqliteStore(const std::filesystem::path& folder, LeaseRules rules, ClockMs clock);

    SubmitResult submit(const NewReport& report, std::size_t max_queued) override;
    std::optional<ReportRecord> find(const std::string& id) override;
    ReportPage list(const ListFilter& filter) override;
    RemoveResult remove(const std::string& id) override;
    std::optional<Blob> find_blob(const std::string& sha256) override;
    void add_asset(const Asset& asset, const std::string& bytes) override;
    std::optional<Asset> find_asset(const std::string& sha256) override;
    std::optional<Asset> find_whole_asset(const std::string& sha256) override;
    std::vector<Asset> list_assets(int limit) override;
    RemoveAssetResult remove_asset(const std::string& sha256) override;
    std::int64_t change_counter() override;
    std::optional<std::int64_t> last_rendered_ms() override;
    std::string lack_of_room() override;

    std::optional<Lease> lease(const std::string& owner) override;
    LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) override;
    LeaseState state(const Lease& lease) override;
    bool commit(const Lease& lease, const FinishedReport& finished) override;
    void fail(const Lease& lease, const JobError& error, bool retry) override;
    void fail_by_signal(const Lease& lease, const JobError& error, int signal) override;
    void set_back(const Lease& lease, const JobError& error, bool lacks_room) override;
    void cancel(const Lease& lease) override;
    void release(const Lease& lease) override;
    void end_leases_of(const std::string& owner) override;
    void note_rendered() override;

  private:
    /// A transaction that must come through also on a full disk, since it makes room or says what became of a job: for
    /// it the reserve is given up. `work` may run twice.
    template <typename Work>
    auto essential(const Work& work) {
        try {
            return transacted(m_mutex, m_database, work);
        } catch (const StoreFull&) {
            m_room.give_up_reserve();
        }
        return transacted(m_mutex, m_database, work);
    }
    /// Carries the log over into the database, so that a copy of its file alone has everything.
    void checkpoint();
    /// Keeps the pictures; those that were not there yet are appended to `added`.
    void put_blobs(const std::vector<BlobFile>& blobs, std::vector<std::string>& added);
    bool commit_rows(const Lease& lease, const FinishedReport& finished, std::vector<std::string>& added);
    void remove_blobs(const std::vector<std::string>& candidates);
    void remove_unnamed_files(const std::vector<std::string>& candidates);
    std::optional<std::string> media_type_of_blob(const std::string& sha256);
    Asset read_asset(SQLite::Statement& row) const;
    void remove_asset_file_without_row(const std::string& sha256);

    // These run inside the caller's transaction.
    void migrate(const std::filesystem::path& folder);
    std::string find_lack_of_room();
    void insert_report(const NewReport& report);
    void try_again_what_lacked_room();
    void end_attempt(const std::string& id, const JobError& error, Status status);
    void requeue(const std::string& id, int attempts);
    void end_lost_leases(const std::string& condition, const std::string& value);
    void write_rendered();

    LeaseRules m_rules;
    ClockMs m_clock;
    BlobStore m_blobs, m_assets;
    DiskRoom m_room;
    std::mutex m_mutex;  ///< guards m_database
    SQLite::Database m_database;
    std::atomic<bool> m_checkpoint_due = false;  ///< a part of the log was left
    std::mutex m_watch_mutex;                    ///< guards m_watch
    /// Never writes, so that its `data_version` moves with every commit of any other connection.
    SQLite::Database m_watch;
};

}  // namespace sheer
