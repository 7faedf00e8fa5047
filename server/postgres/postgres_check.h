#pragma once
#include <string>

#include "server/jobs/care.h"
#include "server/postgres/database.h"

namespace sheer::postgres {

/// Finds what is wrong with a store (see Care::check), reading one row after the other, so that it can be large.
class PostgresCheck {
  public:
    explicit PostgresCheck(Database& database) : m_database(database) {}

    /// Once.
    CheckResult run();

  private:
    void check_reports();
    void check_report(Connection& connection, const std::string& id);
    /// Compares the bytes of each row of `table` with their hash.
    void check_bytes(const std::string& table, const std::string& what, std::int64_t& count);
    void check_leftovers();
    void add(Finding::Kind kind, std::string text) { m_result.findings.push_back({kind, std::move(text)}); }

    Database& m_database;
    CheckResult m_result;
};

}  // namespace sheer::postgres
