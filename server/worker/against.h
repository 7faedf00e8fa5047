#pragma once
#include "server/jobs/job_queue.h"
#include "server/jobs/store.h"

namespace sheer {

/// If the spec of a finished report has an `against`, compares it with the report that this names, or with one of the
/// accepted reports of the baseline that it names, newest first: see renderer/files/against.h. Throws StoreError if the
/// archive cannot be read.
void compare_with_baseline(Store& store, FinishedReport& finished);

}  // namespace sheer
