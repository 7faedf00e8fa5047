#pragma once
#include <filesystem>
#include <string>

#include "server/jobs/job_queue.h"
#include "server/jobs/store.h"
#include "server/process/ask_child.h"

namespace sheer {

/// If the spec of a finished report has an `against`, compares it with the report that this names, or with one of the
/// accepted reports of the baseline that it names, newest first: see renderer/diff/against.h. A child does it, as it
/// decodes `pictures`, the renderer's folder, and those of the archive in `data`. Throws StoreError if the archive
/// cannot be read, std::runtime_error if the child fails.
void compare_with_baseline(Store& store, FinishedReport& finished, const std::filesystem::path& pictures,
                           const std::string& data, const ChildLimits& limits);

}  // namespace sheer
