#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "server/jobs/job_queue.h"
#include "server/postgres/connection.h"

namespace sheer::postgres {

// Inside a transaction.

/// Adds a report without a job, as created now if there is no `created_ms`. Returns false if its idempotency key is
/// known.
bool insert_report(Connection& connection, const NewReport& report, std::optional<std::int64_t> created_ms);
/// Makes a report done, and ends its job if it has one.
void finish_report(Connection& connection, const std::string& id, const FinishedReport& finished);
/// Writes that the report names these pictures, which are stored.
void name_pictures(Connection& connection, const std::string& id, const std::vector<BlobName>& blobs);
/// Stores the pictures that are not stored yet; with `mend`, also those whose stored bytes have another hash. Returns
/// how many it wrote. Throws StoreError if one has other bytes than its name says.
int put_blobs(Connection& connection, const FinishedReport& finished, bool mend);
/// A report that has numbers keeps them.
void add_numbers(Connection& connection, const std::string& report_id, const ReportNumbers& numbers);

}  // namespace sheer::postgres
