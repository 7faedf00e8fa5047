#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/job_error.h"
#include "server/jobs/parts.h"
#include "server/jobs/status.h"

namespace sheer {

/// A report or the job that will become one.
struct ReportRecord {
    std::string id;
    Status status = Status::queued;
    double progress = 0;        ///< 0..1
    std::string stage;          ///< what the renderer is doing
    std::int64_t revision = 0;  ///< grows with every change that a reader can see
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> finished_ms;
    std::string spec;
    std::string spec_sha256;
    std::optional<JobError> error;  ///< of a failed report
    std::string report;             ///< JSON text of a done report, otherwise empty
    std::vector<PartState> parts;   ///< of one of several devices that has not ended
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
    std::string verdict;  ///< empty until done
    std::string device;   ///< the renderer; empty until done
    bool pinned = false;
    nlohmann::json preview = nullptr;  ///< image object of a done report, or null
    std::string broken;                ///< what cannot be read of this line; empty if all can
};

/// As many matching reports are counted; all of them if the filter has at most one field.
inline constexpr std::int64_t max_exact_count = 10'000;

/// Which reports to list; an empty field asks for all.
struct ListFilter {
    std::string q;  ///< words, each of which begins a word of the title or of a tag's value; see search.h
    std::vector<std::string> tags;     ///< each "name" or "name:value"
    std::vector<std::string> methods;  ///< ids
    std::string scene;                 ///< type
    std::string device;                ///< the renderer of a done report, or a word of its name
    std::string verdict;
    std::string spec_sha256;
    std::optional<Status> status;
    std::optional<std::int64_t> since_ms, until_ms;  ///< when it was created, both included
    std::string before_id;                           ///< only reports older than this one
    int limit = 20;
};

struct ReportPage {
    std::vector<ReportSummary> reports;  ///< newest first
    bool more = false;                   ///< whether older ones match as well
    std::int64_t count = 0;              ///< all that match, whatever `before_id`, or at least max_exact_count
    bool count_is_exact = true;          ///< false: there are more than `count`
};

/// Every report, from the moment it is queued.
class ReportArchive {
  public:
    enum class Removal { not_found, cancelled, cancelling, deleted, accepted, pinned };

    virtual ~ReportArchive() = default;
    virtual std::optional<ReportRecord> find(const std::string& id) = 0;
    virtual ReportPage list(const ListFilter& filter) = 0;
    /// Cancels a queued report, asks the worker to cancel a running one, or deletes a final one together with the
    /// pictures that no other report names. One that is accepted in a baseline, or pinned,
    /// stays.
    virtual Removal remove(const std::string& id) = 0;
};

}  // namespace sheer
