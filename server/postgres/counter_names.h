#pragma once
#include <string>

namespace sheer::postgres {

/// Rows of the table counters.
inline const std::string lost_leases_counter = "lost leases", stage_counter_prefix = "stage\x1f";

}  // namespace sheer::postgres
