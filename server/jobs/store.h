#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/jobs/activity.h"
#include "server/jobs/assets.h"
#include "server/jobs/baselines.h"
#include "server/jobs/blobs.h"
#include "server/jobs/care.h"
#include "server/jobs/change_watch.h"
#include "server/jobs/job_queue.h"
#include "server/jobs/pins.h"
#include "server/jobs/readiness.h"
#include "server/jobs/report_archive.h"
#include "server/jobs/trends.h"
#include "server/jobs/usage.h"
#include "server/jobs/workers.h"

namespace sheer {

/// What the service and its workers share. All calls of its parts may be made from any thread and any process, are
/// atomic, may wait for disks, networks and each other, and throw StoreError if they fail.
class Store {
  public:
    virtual ~Store() = default;
    virtual JobQueue& queue() = 0;
    virtual ReportArchive& reports() = 0;
    virtual Blobs& blobs() = 0;
    virtual Assets& assets() = 0;
    virtual Baselines& baselines() = 0;
    virtual Pins& pins() = 0;
    virtual Readiness& readiness() = 0;
    virtual Care& care() = 0;
    virtual Trends& trends() = 0;
    virtual Activity& activity() = 0;
    virtual Workers& workers() = 0;
    virtual Usage& usage() = 0;
    virtual std::unique_ptr<ChangeWatch> watch() = 0;
    /// Changes with each write by any process, before that is acknowledged. Nothing if the store has no such number, or
    /// cannot read it at once.
    virtual std::optional<std::int64_t> version() { return std::nullopt; }
    /// The same only for jobs that may be waiting for a worker now; null if workers have to ask the queue instead.
    virtual std::unique_ptr<ChangeWatch> watch_jobs() = 0;
    /// Copies the pictures and uploads whose SHA-256 `text` names to the data folder of this machine, if they are kept
    /// elsewhere: child processes read them there. Copies of those that the store no longer has are removed.
    virtual void bring_here(const std::string& text) = 0;
};

}  // namespace sheer
