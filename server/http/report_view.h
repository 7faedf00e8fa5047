#pragma once
#include <string>

#include "server/http/message.h"
#include "server/jobs/store.h"

namespace sheer::http {

inline constexpr const char* reports_path = "/api/v1/reports";

/// The report that the path's {id} names. Throws Problem (404).
ReportRecord found_report(Store& store, const Request& request);
/// A JSON object that the archive keeps as a text. Throws DamagedFile, naming `what`, if it is none.
nlohmann::json stored_json(const std::string& text, const std::string& what);
/// The done report `id`. Throws Problem (404, 409), DamagedFile.
nlohmann::json done_report_json(Store& store, const std::string& id);
/// The bytes of a picture of a report, known to be those that its sha256 names. Throws DamagedFile.
std::string picture_bytes(Store& store, const nlohmann::json& image);
/// The report as its readers see it: as committed when it is done, else what is known so far.
std::string report_text(const ReportRecord& record);
nlohmann::json summary_json(const ReportSummary& summary);
/// Its name in the events: progress, done, failed or cancelled.
std::string event_name(Status status);
/// What an event carries.
nlohmann::json event_json(const ReportRecord& record);
/// Changes whenever the text does.
std::string report_etag(const ReportRecord& record);
/// `report_text` as a response, with an ETag that changes whenever the text does.
Response report_response(int status, const ReportRecord& record);

}  // namespace sheer::http
