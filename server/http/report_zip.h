#pragma once
#include <string>

#include "server/jobs/store.h"

namespace sheer::http {

/// A done report with everything, as a ZIP file: report.json, whose pictures are files beside it, report.html,
/// junit.xml, summary.md and the pictures. Throws Problem (404, 409), StoreError.
ContentPtr report_zip(Store& store, const std::string& id);

}  // namespace sheer::http
