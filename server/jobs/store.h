#pragma once
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "server/jobs/status.h"

namespace sheer {

/// The store could not do what was asked: disk full, archive damaged, database locked for too long.
class StoreError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The disk did not do its part. Another time it may.
class DiskError : public StoreError {
    using StoreError::StoreError;
};

/// There is no room for what was to be written, on the disk or among its inodes. The text says so for those who asked.
class StoreFull : public DiskError {
    using DiskError::DiskError;
};

/// A kept file is missing, cannot be read, or has other bytes than its name says. The text says so for those who asked.
class DamagedFile : public StoreError {
    using StoreError::StoreError;
};

/// Whether a system's error means that there is no room: also what std::filesystem and the renderer's WriteError carry.
inline bool means_full_disk(const std::error_code& code) {
    return code == std::errc::no_space_on_device || code == std::error_code(EDQUOT, std::generic_category());
}

/// What a failed report tells its reader.
struct JobError {
    std::string title;
    std::string detail;
};

/// The title of one that was rendered, or could have been.
inline constexpr const char* report_not_kept = "The report could not be kept";

/// The caller's name for a request, by which a repeated one is known.
struct IdempotencyKey {
    std::string key;
    std::string body_sha256;
};

struct NewReport {
    std::string id;
    std::string spec;  ///< canonical text of the normalised spec
    std::string spec_sha256;
    std::optional<IdempotencyKey> idempotency;
};

struct SubmitResult {
    enum class Outcome { created, repeated, key_reused, queue_full };
    Outcome outcome = Outcome::created;
    std::string id;  ///< of the new report, or of the one the key already names
};

/// A report or the job that will become one.
struct ReportRecord {
    std::string id;
    Status status = Status::queued;
    double progress = 0;        ///< 0..1
    std::string stage;          ///< what the renderer is at
    std::int64_t revision = 0;  ///< grows with every change that a reader can see
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> finished_ms;
    std::string spec;
    std::string spec_sha256;
    std::optional<JobError> error;  ///< of a failed one
    std::string report;             ///< JSON text of a done one, else empty
};

/// A line of the archive's list.
struct ReportSummary {
    std::string id;
    Status status = Status::queued;
    double progress = 0;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> finished_ms;
    std::string title;
    std::string scene;
    std::string spec_sha256;
    std::optional<JobError> error;
    std::vector<std::string> methods;  ///< ids, in the order of the spec
    nlohmann::json tags = nlohmann::json::object();
    std::string verdict;               ///< empty until done
    nlohmann::json preview = nullptr;  ///< image object of a done one, or null
    std::string broken;                ///< what of this line cannot be read; empty if it is whole
};

/// Which reports to list; an empty field asks for all.
struct ListFilter {
    std::string q;       ///< part of the title or of a tag's value, without regard to case
    std::string tag;     ///< "name" or "name:value"
    std::string method;  ///< id
    std::string scene;   ///< type
    std::optional<Status> status;
    std::string before_id;  ///< only reports older than this one
    int limit = 20;
};

struct ReportPage {
    std::vector<ReportSummary> reports;  ///< newest first
    bool more = false;                   ///< whether older ones match as well
};

enum class RemoveResult { not_found, cancelled, cancelling, deleted };

/// A worker's right to run a job. It ends when the job ends, or when another worker got the job.
struct Lease {
    std::string id;
    std::string owner;  ///< name of the worker
    int attempt = 0;    ///< from 1
    std::string spec;
    std::string spec_sha256;
    std::int64_t created_ms = 0;
    int setbacks = 0;  ///< how often it was set back before
};

enum class LeaseState { held, cancel_requested, lost };

/// A picture to be kept, as a file outside the store.
struct BlobFile {
    std::string sha256;
    std::string media_type;
    std::filesystem::path path;
};

struct FinishedReport {
    nlohmann::json report;
    std::int64_t finished_ms = 0;
    std::vector<BlobFile> blobs;  ///< every picture that `report` names
};

struct Blob {
    std::string sha256;
    std::string media_type;
    std::filesystem::path path;
};

/// An uploaded file that specs may refer to by its SHA-256.
struct Asset {
    std::string sha256;
    std::string type;  ///< texture, model or volume
    std::string media_type;
    std::string name;  ///< what its sender calls it; may be empty
    std::int64_t size_bytes = 0;
    std::int64_t created_ms = 0;
    nlohmann::json facts;  ///< an object of what its check found
    std::filesystem::path path;
    std::string broken;  ///< what of it is not there any more; empty if it is whole as far as nobody read its bytes
};

enum class RemoveAssetResult { not_found, in_use, removed };

/// The queue of jobs and the archive of reports, shared by the service and its workers. All calls may be made from any
/// thread and any process, take effect whole or not at all, and throw StoreError when they fail.
class Store {
  public:
    virtual ~Store() = default;

    // The service's side.

    /// Queues a report, unless `max_queued` wait already or its idempotency key is known.
    virtual SubmitResult submit(const NewReport& report, std::size_t max_queued) = 0;
    virtual std::optional<ReportRecord> find(const std::string& id) = 0;
    virtual ReportPage list(const ListFilter& filter) = 0;
    /// Cancels a queued report, asks the worker to cancel a running one, deletes a final one with the pictures that no
    /// other report names.
    virtual RemoveResult remove(const std::string& id) = 0;
    /// The bytes were read and have this hash. Throws DamagedFile.
    virtual std::optional<Blob> find_blob(const std::string& sha256) = 0;
    /// Keeps an asset with its bytes; one that is there already keeps its name and type, and gets its bytes back if
    /// they are damaged. `asset.path` means nothing here.
    virtual void add_asset(const Asset& asset, const std::string& bytes) = 0;
    /// Its bytes are not read.
    virtual std::optional<Asset> find_asset(const std::string& sha256) = 0;
    /// The same, and its bytes were read and have this hash. Throws DamagedFile.
    virtual std::optional<Asset> find_whole_asset(const std::string& sha256) = 0;
    /// Newest first.
    virtual std::vector<Asset> list_assets(int limit) = 0;
    /// An asset that a queued or running report refers to stays.
    virtual RemoveAssetResult remove_asset(const std::string& sha256) = 0;
    /// A number that differs from the last call's if anything was written between the two.
    virtual std::int64_t change_counter() = 0;
    /// When a worker last rendered something.
    virtual std::optional<std::int64_t> last_rendered_ms() = 0;
    /// Why no report could be kept at present, for whoever asks; empty if there is room.
    virtual std::string lack_of_room() = 0;

    // The workers' side.

    /// The oldest queued job that is due, now running under `owner`; jobs whose lease ran out are dealt with first.
    /// None while there is no room for reports.
    virtual std::optional<Lease> lease(const std::string& owner) = 0;
    /// Renews the lease and keeps the progress.
    virtual LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) = 0;
    /// The same question without renewing anything: cheap enough to ask often.
    virtual LeaseState state(const Lease& lease) = 0;
    /// Makes the report done with all its pictures, once. Returns false if the lease was lost or the job cancelled.
    virtual bool commit(const Lease& lease, const FinishedReport& finished) = 0;
    /// Ends the attempt without a report; `retry` if another attempt could succeed.
    virtual void fail(const Lease& lease, const JobError& error, bool retry) = 0;
    /// Ends the attempt of a renderer that died of a signal. Another one follows, as after `fail`, unless the same spec
    /// made a renderer die of the same signal before.
    virtual void fail_by_signal(const Lease& lease, const JobError& error, int signal) = 0;
    /// Gives the job back because this machine could not do its part: a disk that is full or fails. It does not count
    /// as an attempt; the next one comes later each time, and after LeaseRules::max_setbacks the job fails with
    /// `error`.
    virtual void set_back(const Lease& lease, const JobError& error, bool lacks_room) = 0;
    /// Ends the attempt because the job was cancelled.
    virtual void cancel(const Lease& lease) = 0;
    /// Gives the job back as if it had not been tried.
    virtual void release(const Lease& lease) = 0;
    /// Ends the leases of a worker that is known to be dead.
    virtual void end_leases_of(const std::string& owner) = 0;
    virtual void note_rendered() = 0;
};

}  // namespace sheer
