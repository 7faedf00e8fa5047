#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/jobs/status.h"

namespace sheer {

/// A report of an archive with everything that the database says about it, to be compared with each other.
class ReportFacts {
  public:
    ReportFacts(SQLite::Database& database, std::string id);

    bool exists() const { return m_exists; }
    /// What of the report itself is not as it was stored, as sentences.
    std::vector<std::string> wrong_contents() const;
    /// Which other rows do not agree with it: its tags, methods and pictures.
    std::vector<std::string> wrong_relations() const;

  private:
    void read_ended_parts();
    bool has_seal() const;
    std::vector<std::string> named(const char* sql) const;

    SQLite::Database& m_database;
    const std::string m_id;
    bool m_exists = false;
    Status m_status = Status::queued;
    std::string m_spec, m_spec_sha256;
    nlohmann::json m_report;
    std::string m_unreadable;  ///< why there is no m_report
};

}  // namespace sheer
