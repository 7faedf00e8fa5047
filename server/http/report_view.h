#pragma once
#include <string>

#include "server/http/message.h"
#include "server/jobs/store.h"

namespace sheer::http {

inline constexpr const char* reports_path = "/api/v1/reports";

/// The report that the path's {id} names. Throws Problem (404).
ReportRecord found_report(Store& store, const Request& request);
/// The report as its readers see it: as committed when it is done, else what is known so far.
std::string report_text(const ReportRecord& record);
nlohmann::json summary_json(const ReportSummary& summary);
/// Its name in the events: progress, done, failed or cancelled.
std::string event_name(Status status);
/// What an event carries.
nlohmann::json event_json(const ReportRecord& record);
/// `report_text` as a response, with an ETag that changes whenever the text does.
Response report_response(int status, const ReportRecord& record);

}  // namespace sheer::http
