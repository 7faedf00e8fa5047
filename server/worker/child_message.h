#pragma once
#include <string>
#include <variant>

#include "server/jobs/store.h"

namespace sheer {

struct ChildProgress {
    double fraction = 0;  ///< 0..1
    std::string stage;
};

/// Nothing: a line that says neither.
using ChildMessage = std::variant<std::monostate, ChildProgress, JobError>;

/// Reads a line of `sheer render`: {"progress": 0.4, "stage": "..."} or {"error": {"kind": "...", "detail": "..."}}.
ChildMessage read_child_message(const std::string& line);

}  // namespace sheer
