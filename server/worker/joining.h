#pragma once
#include <string>

#include "server/jobs/job_queue.h"
#include "server/jobs/store.h"
#include "server/process/ask_child.h"

namespace sheer {

/// What the worker renders: the spec of the lease, or of its part, as canonical text.
std::string spec_to_render(const Lease& lease);

/// The report of several devices whose parts have all ended: see renderer/diff/join.h. A child does it, as it decodes
/// the pictures of the archive in `data`. Throws StoreError if the archive cannot be read, std::runtime_error if the
/// child fails.
FinishedReport joined_report(Store& store, const Lease& lease, std::int64_t finished_ms, const std::string& data,
                             const ChildLimits& limits);

}  // namespace sheer
