#pragma once
#include "server/jobs/job_queue.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

/// Jobs are rows of `jobs`. A worker takes the oldest row that no other transaction holds (FOR UPDATE SKIP LOCKED), and
/// each later step of it first locks the row with its owner and number of attempts, so that a worker that lost its job
/// changes nothing.
class PostgresQueue : public JobQueue {
  public:
    explicit PostgresQueue(Database& database) : m_database(database) {}

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
    std::optional<Lease> take_oldest(Connection& connection, const std::string& owner, const std::string& label);
    /// Of the running jobs that match; those that another transaction holds are left to it.
    void end_lost_leases(Connection& connection, const std::string& condition, const std::vector<Value>& values);

    Database& m_database;
};

}  // namespace sheer::postgres
