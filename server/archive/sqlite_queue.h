#pragma once
#include <vector>

#include "server/archive/sqlite_blobs.h"
#include "server/jobs/job_queue.h"

namespace sheer {

class SqliteQueue : public JobQueue {
  public:
    SqliteQueue(SqliteArchive& archive, SqliteBlobs& blobs) : m_archive(archive), m_blobs(blobs) {}

    SubmitResult submit(const NewReport& report, const QueueLimits& limits) override;
    std::optional<Lease> lease(const std::string& owner, const std::string& label) override;
    LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) override;
    LeaseState state(const Lease& lease) override;
    std::vector<EndedPart> ended_parts(const Lease& lease) override;
    bool commit(const Lease& lease, const FinishedReport& finished) override;
    void fail(const Lease& lease, const JobError& error, bool retry) override;
    void fail_by_signal(const Lease& lease, const JobError& error, int signal) override;
    void set_back(const Lease& lease, const JobError& error, bool lacks_room) override;
    void cancel(const Lease& lease) override;
    void release(const Lease& lease) override;
    void end_leases_of(const std::string& owner) override;

  private:
    /// Stores a picture's bytes; if they were not stored before, it is appended to `added`.
    void put_blob(const FinishedReport& finished, const BlobName& blob, std::vector<std::string>& added);
    bool commit_rows(const Lease& lease, const FinishedReport& finished, std::vector<std::string>& added);
    /// Returns the ids of their jobs.
    std::vector<std::string> end_lost_leases(SQLite::Database& database, const std::string& condition,
                                             const std::string& value);

    SqliteArchive& m_archive;
    SqliteBlobs& m_blobs;
};

}  // namespace sheer
