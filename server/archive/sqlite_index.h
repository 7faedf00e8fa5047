#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

#include "server/jobs/facets.h"
#include "server/jobs/status.h"

namespace sheer {

// The index for searching (search.sql), inside a transaction.

/// The facts by which a report is found.
struct IndexedReport {
    std::string id;
    Status status = Status::queued;
    Facets facets;
    std::string spec_sha256;
    std::string verdict, device;  ///< of a done report
};

/// Adds a report that has a row. Its status is followed by a trigger.
void add_to_index(SQLite::Database& database, const IndexedReport& report);
/// Adds what is known of a report since it is done.
void add_outcome_to_index(SQLite::Database& database, const std::string& id, const std::string& verdict,
                          const std::string& device);
/// The facts as the report's rows have them; an empty device if the text of a done report cannot be read.
IndexedReport indexed_report(SQLite::Database& database, const std::string& id);
/// Whether the index has exactly what add_to_index() writes.
bool is_indexed(SQLite::Database& database, const IndexedReport& report);
/// Makes the index of all reports again.
void rebuild_index(SQLite::Database& database);

}  // namespace sheer
