#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/blobs.h"
#include "server/jobs/job_error.h"
#include "server/jobs/parts.h"
#include "server/jobs/trends.h"

namespace sheer {

/// The caller's name for a request, by which a repeated request is recognized.
struct IdempotencyKey {
    std::string key;
    std::string body_sha256;
};

/// The token with which a report was sent, and what its holder may take up (see TokenUse) without a new one being
/// refused.
struct Sender {
    std::string token;
    std::optional<std::int64_t> max_jobs, max_seconds;
};

struct NewReport {
    std::string id;
    std::string spec;  ///< canonical text of the normalised spec
    std::string spec_sha256;
    std::optional<IdempotencyKey> idempotency;
    std::optional<Sender> sender;
    double cost_mpx = 0;  ///< of rendering it, in whatever measure QueueLimits has
};

/// How much may wait.
struct QueueLimits {
    std::size_t jobs = 0;
    double cost_mpx = std::numeric_limits<double>::infinity();  ///< of all together; one alone may be more

    /// Beside `waiting` jobs of `waiting_mpx` for another one.
    bool have_place(std::int64_t waiting, double waiting_mpx, double another_mpx) const {
        return static_cast<std::size_t>(waiting) < jobs && (waiting == 0 || waiting_mpx + another_mpx <= cost_mpx);
    }
};

struct SubmitResult {
    enum class Outcome { created, repeated, key_reused, queue_full, too_many_jobs, seconds_used_up };
    Outcome outcome = Outcome::created;
    std::string id;  ///< of the new report, or of the one that the key already names
};

/// A worker's right to run a job. It ends when the job ends or when another worker gets the job.
struct Lease {
    std::string id;
    std::string owner;  ///< name of the worker
    int attempt = 0;    ///< from 1
    std::string spec;
    std::string spec_sha256;
    std::int64_t created_ms = 0;
    int setbacks = 0;  ///< how often it was set back before
    /// Of a report of several devices: the label of the one whose part is rendered; empty if all of them have ended, so
    /// that the parts are joined now.
    std::string part;
    int parts = 0;        ///< how many parts the report has; 0 if it is not of several devices
    int parts_ended = 0;  ///< how many of them have ended

    bool joins() const { return parts > 0 && part.empty(); }
};

enum class LeaseState { held, cancel_requested, lost };

struct FinishedReport {
    nlohmann::json report;
    std::int64_t finished_ms = 0;
    ReportNumbers numbers;        ///< see Trends; empty names: none
    std::vector<BlobName> blobs;  ///< every picture that `report` names, each once
    /// The bytes of one of `blobs`; may be called more than once for each. May throw.
    std::function<std::string(const std::string& sha256)> read_blob;
};

/// The jobs that are queued or running. A job has the id of the report that it becomes.
class JobQueue {
  public:
    virtual ~JobQueue() = default;

    /// Queues a report, unless its idempotency key is known, more than `limits` would wait, or its sender takes up as
    /// much as it may. Throws StoreFull.
    virtual SubmitResult submit(const NewReport& report, const QueueLimits& limits) = 0;

    // The workers' side.

    /// The oldest queued job that is due and whose spec asks for no device or for `label`, now running under `owner`;
    /// jobs whose lease expired are dealt with first. None while there is no room for reports. The parts of a report
    /// of several devices are leased one after the other, in the order in which workers ask; when all have ended, any
    /// worker gets it to join them.
    virtual std::optional<Lease> lease(const std::string& owner, const std::string& label) = 0;
    /// For a worker without a label.
    std::optional<Lease> lease(const std::string& owner) { return lease(owner, ""); }
    /// Renews the lease and stores the progress.
    virtual LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) = 0;
    /// The same question without renewing anything: cheap enough to ask often.
    virtual LeaseState state(const Lease& lease) = 0;
    /// The parts that have ended, with their texts. Throws DamagedData.
    virtual std::vector<EndedPart> ended_parts(const Lease& lease) = 0;
    /// Makes the report done with all its pictures, once, or ends the part of the lease, after which the job waits for
    /// another device or for being joined. Returns false if the lease was lost or the job cancelled.
    virtual bool commit(const Lease& lease, const FinishedReport& finished) = 0;
    /// Ends the attempt without a report; `retry` if another attempt could succeed. Where a job would fail for good, a
    /// part does, and the others go on; the job fails if all of them did.
    virtual void fail(const Lease& lease, const JobError& error, bool retry) = 0;
    /// Ends the attempt of a renderer that was killed by a signal. Another one follows, as after `fail`, unless the
    /// same spec has killed a renderer by the same signal before.
    virtual void fail_by_signal(const Lease& lease, const JobError& error, int signal) = 0;
    /// Gives the job back because the disk of this machine is full or fails. This does not count as an attempt; the
    /// wait for the next one grows each time, and after LeaseRules::max_setbacks the job fails with `error`.
    virtual void set_back(const Lease& lease, const JobError& error, bool lacks_room) = 0;
    /// Ends the attempt because the job was cancelled.
    virtual void cancel(const Lease& lease) = 0;
    /// Gives the job back as if it had not been tried.
    virtual void release(const Lease& lease) = 0;
    /// Ends the leases of a worker that is known to be dead.
    virtual void end_leases_of(const std::string& owner) = 0;
};

}  // namespace sheer
