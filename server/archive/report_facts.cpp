#include "server/archive/report_facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/sha256.h"
#include "server/archive/sqlite_steps.h"
#include "server/jobs/facets.h"
#include "server/jobs/store_errors.h"

namespace sheer {

using nlohmann::json;

namespace {

/// "SHA-256 media type" of each picture of a reference or a result.
void collect_pictures(const json& part, std::vector<std::string>& found) {
    for (const json& picture : part.value("images", json::object()))
        found.push_back(picture.value("sha256", "") + " " + picture.value("media_type", ""));
}

std::vector<std::string> sorted(std::vector<std::string> texts) {
    std::ranges::sort(texts);
    const auto [first, last] = std::ranges::unique(texts);
    texts.erase(first, last);
    return texts;
}

}  // namespace

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
    if (m_status != Status::done) return;
    try {
        m_report = json::parse(document_in(row.getColumn(3), row.getColumn(4), m_id), nullptr, false);
        if (!m_report.is_object()) m_unreadable = "its text is not JSON";
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
    std::vector<std::string> wrong;
    const Facets facets = facets_of(json::parse(m_spec, nullptr, false));
    if (named("SELECT method FROM report_methods WHERE report_id = ? ORDER BY position") != facets.methods)
        wrong.emplace_back("its methods are not those of its spec");
    std::vector<std::string> tags;
    for (const auto& [name, value] : facets.tags.items()) tags.push_back(name + "\x1f" + value.get<std::string>());
    if (named("SELECT name || char(31) || value FROM report_tags WHERE report_id = ? ORDER BY 1") != sorted(tags))
        wrong.emplace_back("its tags are not those of its spec");
    if (m_report.is_object() &&
        sorted(pictures_in_text()) != sorted(named("SELECT sha256 || ' ' || coalesce(media_type, '') FROM report_blobs "
                                                   "LEFT JOIN blobs USING (sha256) WHERE report_id = ?")))
        wrong.emplace_back("its pictures are not those that its text names");
    return wrong;
}

std::vector<std::string> ReportFacts::pictures_in_text() const {
    std::vector<std::string> pictures;
    for (const json& run : m_report.value("runs", json::array())) {
        collect_pictures(run.value("reference", json::object()), pictures);
        for (const json& result : run.value("results", json::array())) collect_pictures(result, pictures);
    }
    return pictures;
}

std::vector<std::string> ReportFacts::named(const char* sql) const {
    std::vector<std::string> names;
    SQLite::Statement rows(m_database, sql);
    rows.bind(1, m_id);
    while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
    return names;
}

}  // namespace sheer
