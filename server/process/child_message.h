#pragma once
#include <string>
#include <variant>

#include "server/jobs/job_error.h"

namespace sheer {

struct ChildProgress {
    double fraction = 0;  ///< 0..1
    std::string stage;
};

struct ChildError {
    JobError error;
    bool is_of_disk = false;  ///< not the job's fault: a file could not be written
    bool lacks_room = false;  ///< because the disk is full
};

/// Empty for a line that is neither.
using ChildMessage = std::variant<std::monostate, ChildProgress, ChildError>;

/// Reads a line of `sheer render`: {"progress": 0.4, "stage": "..."} or {"error": {"kind": "...", "detail": "..."}}; an
/// error of the kind "storage" may say "full": true.
ChildMessage read_child_message(const std::string& line);

}  // namespace sheer
