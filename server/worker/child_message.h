#pragma once
#include <string>
#include <variant>

#include "server/jobs/store.h"

namespace sheer {

struct ChildProgress {
    double fraction = 0;  ///< 0..1
    std::string stage;
};

struct ChildError {
    JobError error;
    bool is_of_disk = false;  ///< not the job's fault: the disk refused a file
    bool lacks_room = false;  ///< because it is full
};

/// Nothing: a line that says neither.
using ChildMessage = std::variant<std::monostate, ChildProgress, ChildError>;

/// Reads a line of `sheer render`: {"progress": 0.4, "stage": "..."} or {"error": {"kind": "...", "detail": "..."}}; an
/// error of the kind "storage" may say "full": true.
ChildMessage read_child_message(const std::string& line);

}  // namespace sheer
