#pragma once
#include <string>
#include <vector>

#include "renderer/results/report.h"
#include "server/http/answers.h"
#include "server/http/message.h"
#include "server/http/paths.h"
#include "server/http/service.h"
#include "server/jobs/store.h"
#include "server/jobs/store_errors.h"

namespace sheer::http {

/// The report with the path's {id}. Throws Problem (404).
ReportRecord found_report(Store& store, const Request& request);
/// A JSON object that the archive stores as text. Throws DamagedData, naming `what`, if it is not one.
nlohmann::json stored_json(const std::string& text, const std::string& what);
/// The report of a record, whatever its status. Throws DamagedData.
report::Report report_of(const ReportRecord& record);
/// The record of the done report `id`. Throws Problem (404, 409).
ReportRecord done_record(Store& store, const std::string& id);
/// The done report `id`. Throws Problem (404, 409), DamagedData.
report::Report done_report(Store& store, const std::string& id);
/// The bytes of a picture of a report, which are known to match its SHA-256. Throws DamagedData.
std::string picture_bytes(Store& store, const report::Picture& picture);
/// Why a queued report may have to wait long.
std::vector<Note> queue_notes(const Service& service, const ReportRecord& record);
/// The report as its readers see it: as committed if it is done, otherwise what is known so far.
std::string report_text(const ReportRecord& record, const std::vector<Note>& notes = {});
/// A report in the list.
answer::ReportLine line_of(const ReportSummary& summary);
/// Its name in the events: progress, done, failed or cancelled.
std::string event_name(Status status);
/// The data of an event.
nlohmann::json event_json(const ReportRecord& record);
/// Changes whenever the text does.
std::string report_etag(const ReportRecord& record, const std::vector<Note>& notes = {});
/// The text of a report as a response.
Response report_response(int status, std::string text, std::string etag);
/// `report_text` as a response, with an ETag that changes whenever the text does.
Response report_response(int status, const ReportRecord& record, const std::vector<Note>& notes = {});

/// Runs `use`, which reads a report of the archive. Throws DamagedData, naming the report, if `use` throws
/// DocumentError.
template <typename Use>
void use_stored(const std::string& id, const Use& use) {
    try {
        use();
    } catch (const DocumentError& wrong) {
        throw DamagedData("the report " + id + ": " + wrong.what());
    }
}

}  // namespace sheer::http
