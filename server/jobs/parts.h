#pragma once
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/job_error.h"
#include "server/jobs/status.h"

namespace sheer {

/// The part of a report of several devices that one of them rendered, or failed to render.
struct EndedPart {
    std::string label;
    std::string report;             ///< JSON text of what it rendered; empty if it failed
    std::optional<JobError> error;  ///< if it failed
};

/// A part of a report that has not ended, as its readers see it.
struct PartState {
    std::string label;
    Status status = Status::queued;
    std::optional<JobError> error;  ///< if it failed
};

/// The states of the parts with these labels.
std::vector<PartState> part_states(const std::vector<std::string>& labels, const std::vector<EndedPart>& ended,
                                   const std::string& running);

/// The error of a report all of whose parts failed.
JobError every_part_failed(const std::vector<EndedPart>& parts);

/// How much of a report is done when a part of it is, 0..1. Joining the parts is the last of `parts` + 1 steps.
inline double parts_progress(int ended, int parts, double of_this_one) {
    return parts == 0 ? of_this_one : (ended + of_this_one) / (parts + 1);
}

}  // namespace sheer
