#pragma once
#include <string>

namespace sheer {

/// The error of a failed report, for its reader.
struct JobError {
    std::string title;
    std::string detail;
};

/// The title of the error if the report was rendered, or could have been.
inline constexpr const char* report_not_kept = "The report could not be kept";

}  // namespace sheer
