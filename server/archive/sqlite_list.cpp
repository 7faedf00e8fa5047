#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "server/archive/list_query.h"
#include "server/archive/sqlite_reports.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

using nlohmann::json;

namespace {

ReportSummary summary_of(SQLite::Database& database, SQLite::Statement& row) {
    ReportSummary summary{.id = row.getColumn(0).getString()};
    summary.status = status_from(row.getColumn(1).getString()).value_or(Status::failed);
    summary.progress = row.getColumn(2).getDouble();
    summary.created_ms = row.getColumn(3).getInt64();
    if (!row.getColumn(4).isNull()) summary.finished_ms = row.getColumn(4).getInt64();
    summary.title = row.getColumn(5).getString();
    summary.scene = row.getColumn(6).getString();
    summary.spec_sha256 = row.getColumn(7).getString();
    summary.error = error_of(row.getColumn(8), row.getColumn(9));
    summary.verdict = row.getColumn(10).getString();
    if (!row.getColumn(11).isNull()) {
        summary.preview = json::parse(row.getColumn(11).getString(), nullptr, false);
        if (!summary.preview.is_object()) {
            spdlog::error("report {}: its preview in the archive is not JSON", summary.id);
            summary.preview = nullptr;
            summary.broken = "its preview cannot be read";
        }
    }
    summary.device = row.getColumn(12).getString();
    summary.pinned = row.getColumn(13).getInt() != 0;
    SQLite::Statement methods(database, "SELECT method FROM report_methods WHERE report_id = ? ORDER BY position");
    methods.bind(1, summary.id);
    while (methods.executeStep()) summary.methods.push_back(methods.getColumn(0).getString());
    SQLite::Statement tags(database, "SELECT name, value FROM report_tags WHERE report_id = ?");
    tags.bind(1, summary.id);
    while (tags.executeStep()) summary.tags[tags.getColumn(0).getString()] = tags.getColumn(1).getString();
    return summary;
}

}  // namespace

ReportPage SqliteReports::list(const ListFilter& filter) {
    return m_archive.read([&](SQLite::Database& database) {
        // One transaction, so that the lines, their methods and their tags are consistent.
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::DEFERRED);
        const ListQuery query(database, filter);
        ReportPage page;
        std::vector<std::int64_t> places;
        if (query.counts_by_reading()) {
            places = query.first_places();
            page.count_is_exact = static_cast<std::int64_t>(places.size()) <= max_exact_count;
            page.count = std::min(static_cast<std::int64_t>(places.size()), max_exact_count);
        } else {
            page.count = query.known_count();
        }
        // The first page is the begin of what is counted.
        if (!query.counts_by_reading() || !filter.before_id.empty()) places = query.page();
        page.more = places.size() > static_cast<std::size_t>(filter.limit);
        if (page.more) places.resize(static_cast<std::size_t>(filter.limit));
        SQLite::Statement line(
            database,
            "SELECT id, status, progress, created_ms, finished_ms, title, scene, spec_sha256, error_title, "
            "error_detail, verdict, preview, device, EXISTS (SELECT 1 FROM pins p WHERE p.report_id = id) "
            "FROM search_lines JOIN reports ON id = report_id WHERE place = ?");
        for (const std::int64_t place : places) {
            line.bind(1, place);
            if (line.executeStep()) page.reports.push_back(summary_of(database, line));
            line.reset();
        }
        return page;
    });
}

}  // namespace sheer
