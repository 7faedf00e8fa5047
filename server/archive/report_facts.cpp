#include "server/archive/report_facts.h"

#include "renderer/core/sha256.h"
#include "server/archive/sqlite_parts.h"
#include "server/archive/sqlite_steps.h"
#include "server/jobs/store_errors.h"
#include "server/storage/stored_report.h"

namespace sheer {

using nlohmann::json;

ReportFacts::ReportFacts(SQLite::Database& database, std::string id) : m_database(database), m_id(std::move(id)) {
    SQLite::Statement row(database,
                          "SELECT status, spec, spec_sha256, sha256, packed FROM reports LEFT JOIN documents "
                          "ON report_id = id WHERE id = ?");
    row.bind(1, m_id);
    m_exists = row.executeStep();
    if (!m_exists) return;
    m_status = status_of(row.getColumn(0));
    m_spec = row.getColumn(1).getString();
    m_spec_sha256 = row.getColumn(2).getString();
    if (!is_final(m_status)) read_ended_parts();
    if (m_status != Status::done) return;
    try {
        m_report = json::parse(document_in(row.getColumn(3), row.getColumn(4), m_id), nullptr, false);
        if (!m_report.is_object()) m_unreadable = "its text is not JSON";
    } catch (const DamagedData& damaged) {
        m_unreadable = damaged.what();
    }
}

/// The pictures of a report of several devices belong to its parts until these are joined.
void ReportFacts::read_ended_parts() {
    try {
        const std::vector<EndedPart> parts = read_parts(m_database, m_id, true);
        if (!parts.empty()) m_report = joined_runs(parts);
    } catch (const DamagedData& damaged) {
        m_unreadable = damaged.what();
    }
}

std::vector<std::string> ReportFacts::wrong_contents() const {
    std::vector<std::string> wrong;
    if (!m_unreadable.empty()) wrong.push_back(m_unreadable);
    if (sha256_hex(m_spec) != m_spec_sha256) wrong.emplace_back("its spec has another hash");
    if (is_final(m_status) && !has_seal()) wrong.emplace_back("its row was changed after it ended");
    return wrong;
}

bool ReportFacts::has_seal() const {
    SQLite::Statement row(m_database,
                          "SELECT 1 FROM report_seals s JOIN sealed_reports r ON r.report_id = s.report_id "
                          "WHERE s.report_id = ? AND s.sha256 = r.sha256");
    row.bind(1, m_id);
    return row.executeStep();
}

std::vector<std::string> ReportFacts::wrong_relations() const {
    return sheer::wrong_relations(
        m_spec, m_report,
        {.methods = named("SELECT method FROM report_methods WHERE report_id = ? ORDER BY position"),
         .tags = named("SELECT name || char(31) || value FROM report_tags WHERE report_id = ?"),
         .pictures = named("SELECT sha256 || ' ' || coalesce(media_type, '') FROM report_blobs LEFT JOIN blobs USING "
                           "(sha256) WHERE report_id = ?")});
}

std::vector<std::string> ReportFacts::named(const char* sql) const {
    std::vector<std::string> names;
    SQLite::Statement rows(m_database, sql);
    rows.bind(1, m_id);
    while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
    return names;
}

}  // namespace sheer
