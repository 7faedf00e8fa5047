#pragma once
#include <filesystem>

#include "server/jobs/care.h"

namespace sheer::cli {

/// Reads a report.zip of a service. Throws UsageError if it is not one: no report.json, a report that is not done, a
/// spec with another hash, a picture that is missing, has another hash or is not a picture.
ImportedReport read_report_zip(const std::filesystem::path& file);

}  // namespace sheer::cli
