#include "server/postgres/postgres_check.h"

#include <fmt/format.h>

#include "renderer/core/sha256.h"
#include "server/jobs/facets.h"
#include "server/jobs/search.h"
#include "server/postgres/postgres_parts.h"
#include "server/storage/stored_report.h"

namespace sheer::postgres {

using nlohmann::json;

namespace {

std::vector<std::string> texts_of(Connection& connection, const std::string& sql,
                                  const std::vector<Value>& values = {}) {
    const Rows rows = connection.run(sql, values);
    std::vector<std::string> texts;
    for (int i = 0; i < rows.count(); ++i) texts.push_back(rows.text(i, 0));
    return texts;
}

constexpr int keys_at_once = 1000;

}  // namespace

CheckResult PostgresCheck::run() {
    check_reports();
    check_bytes("blobs", "picture", m_result.pictures);
    check_bytes("assets", "upload", m_result.uploads);
    check_leftovers();
    return m_result;
}

void PostgresCheck::check_reports() {
    std::vector<std::string> ids;
    for (std::string after;; after = ids.back()) {
        ids = m_database.read([&](Connection& connection) {
            return texts_of(connection, "SELECT id FROM reports WHERE id > $1 ORDER BY id LIMIT $2",
                            {after, std::int64_t{keys_at_once}});
        });
        for (const std::string& id : ids) {
            try {
                m_database.read_one_state([&](Connection& connection) { check_report(connection, id); });
            } catch (const StoreUnreachable&) {
                throw;
            } catch (const StoreError& error) {
                add(Finding::Kind::damage, fmt::format("report {} cannot be read: {}", id, error.what()));
            }
            ++m_result.reports;
        }
        if (ids.size() < keys_at_once) return;
    }
}

void PostgresCheck::check_report(Connection& connection, const std::string& id) {
    const Rows row = connection.run(
        "SELECT coalesce(status, ''), spec, spec_sha256, methods, tags, verdict, device, facets, d.sha256, d.packed, "
        "(status IS NULL) = EXISTS (SELECT FROM jobs j WHERE j.report_id = id) FROM reports LEFT JOIN documents d ON "
        "d.report_id = id WHERE id = $1",
        {id});
    if (row.empty()) return;
    std::vector<std::string> wrong;
    const std::string spec = row.text(0, 1);
    const bool is_done = row.text(0, 0) == status_text(Status::done);
    json report;
    if (is_done && row.is_null(0, 9)) wrong.emplace_back("its text is missing");
    if (is_done && !row.is_null(0, 9))
        report = json::parse(stored_report_text(row.bytes(0, 9), row.text(0, 8), id), nullptr, false);
    // The pictures of a report of several devices belong to its parts until these are joined.
    if (row.text(0, 0).empty())
        if (const auto parts = read_parts(connection, id, true); !parts.empty()) report = joined_runs(parts);
    if (is_done && report.is_discarded()) wrong.emplace_back("its text is not JSON");
    if (sha256_hex(spec) != row.text(0, 2)) wrong.emplace_back("its spec has another hash");
    if (!row.flag(0, 10)) wrong.emplace_back("it has both a final status and a job, or neither");
    StoredRelations stored{.methods = row.texts(0, 3)};
    const json tags = json::parse(row.text(0, 4), nullptr, false);
    for (const auto& [name, value] : tags.items())
        if (value.is_string()) stored.tags.push_back(tag_text(name, value.get<std::string>()));
    stored.pictures = texts_of(connection,
                               "SELECT sha256 || ' ' || media_type FROM report_blobs JOIN blobs USING (sha256) WHERE "
                               "report_id = $1",
                               {id});
    for (std::string& text : wrong_relations(spec, report, stored)) wrong.push_back(std::move(text));
    std::vector<std::string> facets = facet_texts(facets_of(json::parse(spec, nullptr, false)), row.text(0, 2));
    if (is_done)
        for (std::string& text : outcome_facet_texts(row.text(0, 5), renderer_of(report)))
            facets.push_back(std::move(text));
    if (row.texts(0, 7) != facets) wrong.emplace_back("it is not in the index for searching as it should be");
    for (const std::string& text : wrong) add(Finding::Kind::damage, fmt::format("report {}: {}", id, text));
}

void PostgresCheck::check_bytes(const std::string& table, const std::string& what, std::int64_t& count) {
    std::string last;
    while (true) {
        const bool found = m_database.read([&](Connection& connection) {
            const Rows row = connection.run(
                fmt::format(
                    "SELECT sha256, encode(sha256(bytes), 'hex'), length(bytes), size_bytes FROM {} WHERE sha256 > "
                    "$1 ORDER BY sha256 LIMIT 1",
                    table),
                {last});
            if (row.empty()) return false;
            last = row.text(0, 0);
            m_result.bytes += static_cast<std::uint64_t>(row.integer(0, 2));
            if (row.text(0, 1) != last || row.integer(0, 2) != row.integer(0, 3))
                add(Finding::Kind::damage, fmt::format("the bytes of the {} {} have another hash", what, last));
            return true;
        });
        if (!found) return;
        ++count;
    }
}

void PostgresCheck::check_leftovers() {
    const auto unnamed = m_database.read([](Connection& connection) {
        return texts_of(connection,
                        "SELECT sha256 FROM blobs b WHERE NOT EXISTS (SELECT FROM report_blobs r WHERE r.sha256 = "
                        "b.sha256) LIMIT 1000");
    });
    for (const std::string& sha256 : unnamed)
        add(Finding::Kind::leftover, fmt::format("no report names the picture {}", sha256));
}

}  // namespace sheer::postgres
